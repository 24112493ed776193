#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs the Debian packages that are needed to build, run and test. Prints nothing if all of them
# are already installed.
# Usage: install.sh [LIST]
set -euo pipefail
list=${1:-$(cd "$(dirname "$0")" && pwd)/packages.txt}

# Lists the installed packages and the packages that they provide. For example, the Node.js package
# of its own makers provides npm.
there=$(dpkg-query -W -f '${db:Status-Status}:${Package},${Provides}\n' | sed -n 's/^installed://p' | tr ',' '\n' |
  sed 's/(.*//; s/ //g')
missing=()
while read -r package; do
  grep -qxF "$package" <<<"$there" || missing+=("$package")
done < <(sed 's/#.*//; /^[[:space:]]*$/d' "$list")
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || {
    echo "These Debian packages are missing; install them as root: ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" apt-get install -q -y --no-install-recommends "${missing[@]}"
