# SPDX-License-Identifier: LGPL-2.1-or-later
# Plots a file that scream-matrix --samples has written:
#   gnuplot -e "csv='e.csv'; png='e.png'" tests/benchmarks/scream_plot.gp
set datafile separator comma
set terminal pngcairo size 900,900 font ",10"
set output png
set key top right
set grid
set xrange [0:]
set multiplot layout 3,1
set ylabel "Mbit/s"
plot csv using 1:3 every ::1 with steps lc "black" title "capacity", \
     csv using 1:4 every ::1 with lines lc "blue" title "target", \
     csv using 1:6 every ::1 with lines lc "red" title "acknowledged"
set ylabel "ms"
plot csv using 1:10 every ::1 with lines lc "blue" title "queue delay, as the sender sees it", \
     csv using 1:16 every ::1 with lines lc "red" title "sender's own queue"
set ylabel "kB"
set xlabel "s"
plot csv using 1:($7/1000) every ::1 with lines lc "blue" title "ref\\_wnd", \
     csv using 1:($9/1000) every ::1 with lines lc "red" title "bytes in flight"
unset multiplot
