#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Says what an installed wheel consists of, as a bill of materials (CycloneDX): installs it into an environment of its own,
# with the packages it needs as scripts/wheel.lock pins them with their hashes, and writes dist/oort.cdx.json.
# The system's libraries that the wheel carries are in the bill within it, oort-*.dist-info/sboms.
#   scripts/sbom.sh WHEEL
#   scripts/sbom.sh --lock      writes scripts/wheel.lock anew, with the newest versions
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# = 1 ] || { echo "usage: scripts/sbom.sh WHEEL | --lock" >&2; exit 2; }
tools=build/sbom/tools
[ -x $tools/bin/cyclonedx-py ] || { python3 -m venv $tools && $tools/bin/pip install --quiet "cyclonedx-bom==7.*" "pip-tools==7.*"; }
if [ "$1" = --lock ]; then
  CUSTOM_COMPILE_COMMAND="scripts/sbom.sh --lock" $tools/bin/pip-compile --quiet --upgrade --generate-hashes --strip-extras \
    --no-emit-index-url --no-emit-find-links --no-emit-trusted-host --output-file scripts/wheel.lock pyproject.toml
  exit
fi
python3 -m venv --clear build/sbom/installed
build/sbom/installed/bin/pip install --quiet --require-hashes --requirement scripts/wheel.lock
build/sbom/installed/bin/pip install --quiet --no-deps --no-index "$1"
build/sbom/installed/bin/pip check
mkdir -p dist
$tools/bin/cyclonedx-py environment --output-reproducible --output-file dist/oort.cdx.json build/sbom/installed/bin/python
echo "wrote dist/oort.cdx.json"
