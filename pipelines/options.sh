# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the scripts here: checks of options. Each function gets the option and all that follows it.

wrong() {
  echo "$(basename "$0"): $*; --help lists the options." >&2
  exit 2
}
# text OPTION VALUE ...
text() { [ $# -ge 2 ] && [ -n "$2" ] || wrong "$1 wants a value"; }
# number OPTION VALUE ...: above zero
number() {
  text "$@"
  [[ $2 =~ ^[0-9]+(\.[0-9]+)?$ && ! $2 =~ ^[0.]+$ ]] || wrong "$1 wants a number above zero, not \"$2\""
}
# count OPTION VALUE ...: whole and above zero
count() {
  text "$@"
  [[ $2 =~ ^[1-9][0-9]*$ ]] || wrong "$1 wants a whole number above zero, not \"$2\""
}
# only_count NAME [ARGUMENT ...]: the script takes one count that may be left out, and --help.
only_count() {
  case ${2:-} in
    -h | --help) usage; exit 0 ;;
    -*) wrong "there is no option $2" ;;
    '') ;;
    *) count "$@" ;;
  esac
  [ $# -le 2 ] || wrong "there is nothing to say behind $1"
}
# file OPTION VALUE ...
file() {
  text "$@"
  [ -r "$2" ] || wrong "$1 wants a file that can be read, not $2"
}
# port OPTION VALUE ...
port() {
  count "$@"
  [ "$2" -le 65535 ] || wrong "$1 wants a UDP port, not $2"
}
