#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# run_input_security.sh ALVEOLUS WORK_DIR
#
# Files from somebody else: nothing in them is run as a command, and nothing is
# written outside the output folder. A witness is a file that a planted command
# would make; a victim is a file outside that must stay as it is.
set -euo pipefail

program=$1 work=$(realpath -m "$2")
cd "$(dirname "$0")/../.."
rm -rf "$work"
mkdir -p "$work"
witness=$work/witness output=$work/output scene=$work/scene.prm

fail() { echo "FAILED: $*" >&2; exit 1; }
expect() # CODE PATTERN ARGUMENTS...
{
  local wanted=$1 pattern=$2 code=0
  shift 2
  "$program" --quiet --threads 1 "$@" >"$work/said" 2>&1 || code=$?
  [[ $code == "$wanted" ]] ||
    fail "exit code $code instead of $wanted: $(cat "$work/said")"
  [[ -z $pattern ]] || grep -Eq -e "$pattern" "$work/said" ||
    fail "no '$pattern': $(cat "$work/said")"
  [[ ! -e $witness ]] || fail "a command of a file was run: $*"
}
# The program that would leave the witness
printf '#!/bin/sh\ntouch "%s"\n' "$witness" >"$work/evil"
chmod +x "$work/evil"
command="SystemCall \"touch '$witness'\";"

# A scene cannot name the mesher, neither in the file nor by --set.
cat >"$scene" <<END
include $PWD/prm/academic.prm
subsection Mesh
  subsection tooth in block
    set Mesher program = $work/evil
  end
end
END
expect 2 "scene.prm:4: there is no parameter 'Mesher program'" \
  --output "$output" --validate "$scene"
expect 2 "there is no parameter 'Mesher program'" --output "$output" \
  --set "Remeshing/outline/Mesher program=$work/evil" --validate \
  prm/incisor.prm

# A script as a mesh file is refused, unless the command line allows it: then
# gmsh runs it (and its command, which shows that the witness sees).
cat >"$work/square.geo" <<END
$command
SetFactory("Built-in");
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Transfinite Curve {1:4} = 3; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("body") = {1};
Physical Curve("left") = {4}; Physical Curve("middle") = {4};
Physical Curve("right") = {2};
Physical Curve("bottom") = {1}; Physical Curve("top") = {3};
END
sed "s|square-41.msh|square.geo|; s|include ../../scene|include $PWD/tests/scene|" \
  tests/fuzz/seeds/square.prm >"$work/square.prm"
grep -q square.geo "$work/square.prm" || fail "the seed names no mesh file"
expect 2 "square.geo' is a script of gmsh, which can start programs" \
  --output "$output" --validate "$work/square.prm"
code=0
"$program" --quiet --allow-scripts --output "$output" --validate \
  "$work/square.prm" >"$work/said" 2>&1 || code=$?
[[ $code == 0 ]] || fail "an allowed script was not run: $(cat "$work/said")"
[[ -e $witness ]] || fail "an allowed script started nothing: no witness"
rm "$witness"

# Options of gmsh planted in the output folder: its file of options, the one it
# would read with the script, and old results
rm -rf "$output"
mkdir -p "$output"
for file in .gmshrc .gmsh-options tooth-in-block.geo.opt tooth-in-block.msh.opt
do
  echo "$command" >"$output/$file"
done
(cd "$output" && expect 0 '' --output . --validate "$OLDPWD/prm/academic.prm")
expect 0 '' --output "$output" --validate prm/academic.prm

# Links in the output folder that lead to files outside: not followed.
run=(--set Time/End=0.2 --set 'Checkpoint/Step interval=1' \
  tests/scene/base/academic-interrupted.prm)
victim=$work/victim
for name in history.csv log.txt checkpoint; do
  rm -rf "$output"
  mkdir -p "$output"
  echo precious >"$victim"
  ln -s "$victim" "$output/$name"
  expect 2 "$name: is a link, where a .* is to be written" --output "$output" \
    "${run[@]}"
  [[ $(cat "$victim") == precious ]] || fail "$name was written through a link"
done
rm -rf "$output"
mkdir -p "$output" "$work/elsewhere"
ln -s "$work/elsewhere" "$output/checkpoint"
echo precious >"$work/elsewhere/000001.alv"
expect 2 'checkpoint: is a link' --output "$output" "${run[@]}"
[[ $(cat "$work/elsewhere/000001.alv") == precious ]] ||
  fail "checkpoints of another folder were removed"
rm -rf "$output"
mkdir -p "$output"
mkfifo "$output/history.csv" # would never answer
expect 2 'history.csv: is no file' --output "$output" "${run[@]}"
# Files that are written as a whole take the place of a link.
rm -rf "$output"
mkdir -p "$output"
for name in summary.json parameters.prm tooth-in-block.geo tooth-in-block.msh \
  fields.pvd fields-00000.vtu; do
  ln -s "$victim" "$output/$name"
  ln -s "$victim" "$output/$name.unfinished"
done
expect 0 '' --output "$output" "${run[@]}"
[[ $(cat "$victim") == precious ]] || fail "written through a link"
[[ ! -L $output/summary.json ]] || fail "summary.json is still a link"
# The same when a run goes on
mv "$output/history.csv" "$work/moved.csv"
ln -s "$work/moved.csv" "$output/history.csv"
before=$(cksum <"$work/moved.csv")
expect 2 'history.csv: is a link' --resume "$output"
[[ $(cksum <"$work/moved.csv") == "$before" ]] || fail "written through a link"

# Names that are paths or commands stay names.
rm -rf "$output" "$work/inside"
mkdir -p "$work/inside"
names='../outside, $(touch witness), `touch witness`; touch witness, /abs'
cat >"$scene" <<END
include $PWD/tests/scene/base/academic-interrupted.prm
set Title = "; touch witness; \$(touch witness) $(printf '\xe9') ../outside
subsection Time
  set End = 0.2
end
subsection Records
  set Names = $names
$(IFS=,; for name in $names; do
  echo "subsection ${name# }"; echo "set Type = corner quality"
  echo end; done)
end
END
touch "$work/now"
sleep 0.02
(cd "$work/inside" && expect 0 '' --output "$output" "$scene")
others=$(find "$work" -newer "$work/now" -not -path "$output*" -type f \
  -not -path "$work/said")
[[ -z $others ]] || fail "written outside the output folder: $others"
echo "nothing was run, and nothing written elsewhere"
