# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the scripts in this folder. The functions check options. Each function gets the option
# and all arguments that follow it.

wrong() {
  echo "$(basename "$0"): $*; --help lists the options." >&2
  exit 2
}
# text OPTION VALUE ...: VALUE must not be empty.
text() { [ $# -ge 2 ] && [ -n "$2" ] || wrong "$1 wants a value"; }
# number OPTION VALUE ...: VALUE must be a number above zero.
number() {
  text "$@"
  [[ $2 =~ ^[0-9]+(\.[0-9]+)?$ && ! $2 =~ ^[0.]+$ ]] || wrong "$1 wants a number above zero, not \"$2\""
}
# count OPTION VALUE ...: VALUE must be a whole number above zero.
count() {
  text "$@"
  [[ $2 =~ ^[1-9][0-9]*$ ]] || wrong "$1 wants a whole number above zero, not \"$2\""
}
# only_count NAME [ARGUMENT ...]: the script accepts only --help or a single count, which may be
# left out.
only_count() {
  case ${2:-} in
    -h | --help) usage; exit 0 ;;
    -*) wrong "there is no option $2" ;;
    '') ;;
    *) count "$@" ;;
  esac
  [ $# -le 2 ] || wrong "there is nothing to say behind $1"
}
# file OPTION VALUE ...: VALUE must be a file that can be read.
file() {
  text "$@"
  [ -r "$2" ] || wrong "$1 wants a file that can be read, not $2"
}
# port OPTION VALUE ...: VALUE must be a UDP port.
port() {
  count "$@"
  [ "$2" -le 65535 ] || wrong "$1 wants a UDP port, not $2"
}
