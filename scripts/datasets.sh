#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
# Checks the public recordings in a folder, which tests and measurements find as OORT_DATASETS, and says where those that
# are not there come from. Ends with an error if a file is not the one that the figures of Oort were measured with.
#   scripts/datasets.sh [FOLDER]      FOLDER is $OORT_DATASETS if not given
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-${OORT_DATASETS:-}}
[ -n "$folder" ] || { echo "usage: scripts/datasets.sh FOLDER (or set OORT_DATASETS)" >&2; exit 2; }
[ -d "$folder" ] || { echo "$folder is not a folder; make it and put the files of docs/datasets.md into it" >&2; exit 2; }

# Of packed files what is in them counts: the same log packed by another program is the same log.
contents() { case "$1" in *.bz2) bzip2 -dc "$1" ;; *) cat "$1" ;; esac; }

there=0 absent=0 wrong=0 source=""
while read -r checksum name; do
  case "$checksum" in
    "" | "#") source=$name ;;
    *)
      if [ ! -f "$folder/$name" ]; then
        absent=$((absent + 1))
        echo "absent  $name   from $source"
      elif [ "$(contents "$folder/$name" | sha256sum | cut -d ' ' -f 1)" = "$checksum" ]; then
        there=$((there + 1))
        echo "ok      $name"
      else
        wrong=$((wrong + 1))
        echo "WRONG   $name   is another file, or damaged; it is from $source"
      fi
      ;;
  esac
done <scripts/datasets.sha256
echo "$there ok, $absent absent, $wrong wrong"
[ $wrong = 0 ]
