#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_parameters.sh ALVEOLUS FILE: FILE must be what --print-parameters prints
# (ALVEOLUS_UPDATE=1 writes it).
set -euo pipefail
if [[ ${ALVEOLUS_UPDATE-} == 1 ]]; then
  "$1" --print-parameters >"$2"
fi
"$1" --print-parameters | diff -u "$2" - || {
  echo "FAILED: $2 is not current; ALVEOLUS_UPDATE=1 writes it" >&2
  exit 1
}
