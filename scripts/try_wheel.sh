#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Tries the wheel in dist/ where nothing else is: a bare Debian or Ubuntu with Python (scripts/bare_tree.sh, as root),
# into which pip installs from a folder of wheels, without a network. A home is simulated and mapped there, the picture
# and the page are made, and the map must have the bytes of the map that .venv makes here (on arm64: its poses).
#   scripts/try_wheel.sh [SUITE]      SUITE is bookworm if not given; its Python must be that of the wheel
set -euo pipefail
cd "$(dirname "$0")/.."
suite=${1:-bookworm}
root=build/wheel/$suite
scripts/bare_tree.sh "$suite"

tag=$(chroot "$root" python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
machine=$(chroot "$root" uname -m)
wheel=$(ls dist/oort-*-"$tag"-*_"$machine".whl) || { echo "dist/ has no wheel for $tag on $machine; see scripts/wheel.sh" >&2; exit 1; }
rm -rf "$root"/try && mkdir -p "$root"/try/wheels
if [ "$suite" = arm64 ]; then  # a pip that qemu runs knows best what runs there
  pip=(build/wheel/tools-arm64/bin/pip download)
else
  pip=(.venv/bin/pip download --python-version "${tag#cp}" --only-binary=:all:)
fi
"${pip[@]}" --quiet --dest "$root"/try/wheels "$wheel"
cat >"$root"/try/run.sh <<'RUN'
set -e
cd /try
python3 -m venv venv
venv/bin/pip install --quiet --no-index --find-links wheels oort
venv/bin/oort simulate --seed 3 --minutes 2 --out home
venv/bin/oort replay home/*.bag --out map --quiet
venv/bin/oort check home/*.bag
venv/bin/python -c 'import oort; print(len(oort.load_map("map/map")), "nodes")'
RUN
env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root unshare --net chroot "$root" bash /try/run.sh

.venv/bin/oort replay "$root"/try/home/*.bag --out "$root"/try/here --quiet
for file in map.map_capnp report.html map.png; do
  [ -s "$root"/try/map/$file ] || { echo "$file was not made" >&2; exit 1; }
done
if [ "$suite" = arm64 ]; then  # its multiplications and additions are fused: the last bits differ
  .venv/bin/python - "$root"/try/map/trajectory.tum "$root"/try/here/trajectory.tum <<'RUN'
import sys
import numpy as np
there, here = map(np.loadtxt, sys.argv[1:])
off = np.abs(there - here).max()
print(f"{len(there)} poses differ by {off:.1e} from those made here")
sys.exit(bool(off > 1e-9))
RUN
else
  cmp "$root"/try/map/map.map_capnp "$root"/try/here/map.map_capnp
  echo "Its map has the bytes of the map made here."
fi
echo "The wheel works on $suite."
