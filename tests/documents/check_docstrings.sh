#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_docstrings.sh DOXYGEN SOURCE WORK: every public class and member has a
# text, and what doxygen finds in the texts fits the declarations.
set -euo pipefail
doxygen=$1 source=$2 work=$3
mkdir -p "$work"
sed "s#@CMAKE_SOURCE_DIR@#$source#g; s#@CMAKE_BINARY_DIR@#$work#g; s#@PROJECT_VERSION@##" \
  "$source/doc/Doxyfile.in" >"$work/Doxyfile"
# The texts only, no pages; something has to be made for the warnings to come
printf 'GENERATE_HTML = NO\nGENERATE_TAGFILE = %s/tags\n' "$work" >>"$work/Doxyfile"
"$doxygen" "$work/Doxyfile" >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
if grep -q 'class' "$work/tags" && ! grep -E 'is not documented|argument' "$work/doxygen-warnings.txt"; then
  exit 0
fi
echo "FAILED: the above has no text, or a wrong one" >&2
exit 1
