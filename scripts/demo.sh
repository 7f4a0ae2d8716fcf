#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Sets Oort up, makes a home with a drive through it, maps it, and compares the result with the truth.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
out=oort-out/home
.venv/bin/python -m oort.simulate --seed 1 --name home --out $out
.venv/bin/python -m oort.replay $out/home.bag --events $out/home.events.json --out $out
.venv/bin/python -m oort.evaluate ate $out/trajectory.tum $out/home.truth.tum
echo "Open $out/report.html in a browser, or look at $out/map.png; the saved map is $out/map.map_capnp with its .map_meta_capnp and .md5."
