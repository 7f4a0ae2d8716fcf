#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Makes a bare Debian or Ubuntu with its Python in build/wheel/SUITE with debootstrap, as root; what is there is kept.
# Its Python runs here too, with its own C library, as build/wheel/SUITE/usr/bin/python3-outside: scripts/wheel.sh
# builds with it.
#   scripts/bare_tree.sh bookworm | trixie
#   UBUNTU_MIRROR=URL scripts/bare_tree.sh noble
#   scripts/bare_tree.sh arm64             Debian 12 for 64-bit ARM, whose programs qemu runs (package qemu-user-static)
set -euo pipefail
cd "$(dirname "$0")/.."
suite=${1:-}
root=$PWD/build/wheel/$suite
options=(--variant=minbase "--include=python3-venv,libpython3-dev")
case $suite in
  bookworm | trixie | noble) ;;
  arm64) suite=bookworm; options+=(--arch=arm64) ;;
  *) echo "usage: scripts/bare_tree.sh bookworm | trixie | noble | arm64" >&2; exit 2 ;;
esac
[ ! -x "$root/usr/bin/python3-outside" ] || exit 0
command -v debootstrap >/dev/null || { echo "debootstrap is not there: install Debian's package debootstrap" >&2; exit 1; }
if [ "$1" = arm64 ] && [ "$(uname -m)" != aarch64 ] && [ ! -e /proc/sys/fs/binfmt_misc/qemu-aarch64 ]; then
  echo "arm64 programs do not run here: install Debian's package qemu-user-static, mount binfmt_misc" >&2
  exit 1
fi
mkdir -p build/wheel
if [ "$suite" = noble ]; then
  : "${UBUNTU_MIRROR:?names a mirror of the Ubuntu archive for the processor of this machine}"
  keys=build/wheel/ubuntu-keyring  # Debian 12 has no such package; that of Debian 13 is signed by Debian
  if [ ! -d $keys ]; then
    scripts/bare_tree.sh trixie
    chroot build/wheel/trixie sh -c "cd /tmp && apt-get update -q && apt-get download -q ubuntu-keyring" >"$root.log"
    dpkg-deb -x build/wheel/trixie/tmp/ubuntu-keyring_*.deb $keys
  fi
  options+=("--components=main,universe" "--keyring=$keys/usr/share/keyrings/ubuntu-archive-keyring.gpg")
  origin=("$UBUNTU_MIRROR" gutsy)  # the script of all that came after it
else
  origin=("$({ cat /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null || true; } |
    sed -n 's/^URIs: *//p; s/^deb \(\[.*\] \)\?\(\S*\) .*/\2/p' | head -1)")
fi
rm -rf --one-file-system "$root"
debootstrap "${options[@]}" "$suite" "$root" "${origin[@]}" >>"$root.log"
python=$(readlink -f "$root/usr/bin/python3")
loader=$(ls "$root"/usr/lib/*/ld-linux-*.so.*)
# Debian's pyconfig.h includes that of the processor by a path that the compiler only knows within the tree.
cp "$root"/usr/include/*-linux-gnu/python3.*/pyconfig.h "$root"/usr/include/python3.*/
cat >"$root/usr/bin/python3-outside" <<RUN
#!/bin/sh
exec "$loader" --library-path "${loader%/*}" --argv0 "\$0" "$python" "\$@"
RUN
chmod +x "$root/usr/bin/python3-outside"
