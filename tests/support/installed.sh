# SPDX-License-Identifier: LGPL-2.1-or-later
# To be sourced. `source` and `build` must be set. Makes a folder $work that contains libgstlidar in
# the layout of `meson install`, and sets `flags` to the compiler flags that pkg-config prints for
# it.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/include/gstreamer-1.0/gst/lidar" "$work/lib"
cp "$source"/gst/lidar/gstlidar{,cloud,cloudinfo,decoder,encoder}.h "$work/include/gstreamer-1.0/gst/lidar/"
ln -s "$build"/gst/lidar/libgstlidar-1.0.so* "$work/lib/"
sed -e "s|^prefix=.*|prefix=$work|; s|^includedir=.*|includedir=$work/include|; s|^libdir=.*|libdir=$work/lib|" \
  "$build/meson-private/gstreamer-lidar-1.0.pc" >"$work/gstreamer-lidar-1.0.pc"
flags=$(PKG_CONFIG_PATH=$work pkg-config --cflags --libs gstreamer-lidar-1.0)
export LD_LIBRARY_PATH=$work/lib GST_REGISTRY=$work/registry GST_REGISTRY_FORK=no
