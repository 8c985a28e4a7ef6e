#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# run_scene.sh SCENE.prm ALVEOLUS NUMDIFF WORK_DIR [LAUNCHER...]
#
# Runs a scene and checks what the comments of its file ask for, each on a line
# of its own that begins with "# ":
#
#   exit: 1                  expected exit code (default 0)
#   message: REGEX           extended regular expression that must be found in
#                            stderr or in the reason of summary.json; repeatable
#   compare: COLUMN / SCALE, ...
#                            columns of history.csv, divided by the scale (to
#                            order one; may be left out), that must equal those
#                            in NAME.output; repeatable
#   rows: every N | last     rows compared: every Nth and the last (default last)
#   tolerance: 1e-6          relative (default 1e-8); absolute: a thousandth
#   parallel tolerance: 1e-6 the same on several processes (default: 1e-6, or
#                            the tolerance if that is larger)
#   require: COLUMN >= VALUE, ...
#                            must hold in every row: < <= > >=, |COLUMN| is the
#                            absolute value; repeatable
#   reference: exact         NAME.output is a formula's, never written anew
#   output: FOLDER           output folder instead of one in the build folder
#   arguments: ...           further arguments of the program
#   mpirun: 2                adds a run on two processes   (read by CMake)
#   label: slow              instead of scene              (read by CMake)
#   timeout: 600             seconds instead of 300        (read by CMake)
#
# ALVEOLUS_UPDATE=1 in the environment writes NAME.output anew. Look at the
# difference before you commit it: an expected output is a claim.
set -euo pipefail

scene=$1 program=$2 numdiff=$3 work=$4
shift 4
launcher=("$@")

# From the top folder, so that messages are the same wherever the build is
cd "$(dirname "$scene")/../.."
scene=tests/scene/$(basename "$scene")

fail() { echo "FAILED: $*" >&2; exit 1; }

# All values of a key, one a line
values() { sed -n "s/^# $1: *//p" "$scene"; }
value() # KEY DEFAULT
{
  local found
  found=$(values "$1")
  echo "${found:-$2}"
}

unknown=$(sed -nE 's/^# ([a-z ]+): .*/\1/p' "$scene" | grep -vxE \
  'exit|message|compare|rows|(parallel )?tolerance|require|reference|output|arguments|mpirun|label|timeout' || true)
[[ -z $unknown ]] || fail "$scene: unknown key '$unknown:' in a comment"

rm -rf "$work"
mkdir -p "$work"
output=$(value output "$work/output")
eval "arguments=($(values arguments))"

code=0
"${launcher[@]}" "$program" --quiet --output "$output" "${arguments[@]}" \
  "$scene" >"$work/stdout" 2>"$work/stderr" || code=$?
cat "$work/stdout" "$work/stderr"
expected=$(value exit 0)
[[ $code == "$expected" ]] || {
  grep '"reason"' "$output/summary.json" 2>/dev/null || true
  fail "exit code $code instead of $expected"
}

messages=$work/stderr
[[ ! -e $output/summary.json ]] || messages+=" $output/summary.json"
while IFS= read -r pattern; do
  # shellcheck disable=SC2086
  grep -Eqs -e "$pattern" $messages || fail "no message with '$pattern'"
done < <(values message)

history=$output/history.csv
columns=$(values compare | paste -sd,)
conditions=$(values require | paste -sd,)
[[ $columns || $conditions || $expected == 2 ]] ||
  fail "$scene neither compares nor requires anything"

# check: conditions, each "COLUMN OP VALUE", in every row
if [[ $conditions ]]; then
  awk -F, -v conditions="$conditions" '
    function trim(s) { gsub(/^ +| +$/, "", s); return s }
    NR == 1 {
      for (i = 1; i <= NF; ++i)
        at[$i] = i
      n = split(conditions, condition, ",")
      for (k = 1; k <= n; ++k) {
        if (!match(condition[k], / (<|<=|>|>=) [^ ]+ *$/)) {
          print "not a condition: " condition[k]; failed = 1; exit
        }
        name[k] = trim(substr(condition[k], 1, RSTART - 1))
        split(trim(substr(condition[k], RSTART)), part, " ")
        op[k] = part[1]; bound[k] = part[2] + 0
        absolute[k] = name[k] ~ /^\|.*\|$/
        if (absolute[k])
          name[k] = substr(name[k], 2, length(name[k]) - 2)
        if (!(name[k] in at)) {
          print "no column \"" name[k] "\""; failed = 1; exit
        }
      }
      next
    }
    {
      ++rows
      for (k = 1; k <= n; ++k) {
        text = $at[name[k]]
        v = text + 0
        if (absolute[k] && v < 0) v = -v
        holds = op[k] == "<" ? v < bound[k] : op[k] == "<=" ? v <= bound[k] : \
                op[k] == ">" ? v > bound[k] : v >= bound[k]
        if (text !~ /^[-+]?[0-9.]+(e[-+]?[0-9]+)?$/ || !holds) {
          print "row " NR - 1 ": " name[k] " is " text ", must be " op[k] " " \
                bound[k]
          failed = 1
        }
      }
    }
    END {
      if (!rows) print "history.csv has no row"
      exit failed || !rows
    }' "$history" || fail "a requirement of $scene does not hold"
fi

[[ $columns ]] || exit 0
awk -F, -v columns="$columns" -v rows="$(value rows last)" '
  function trim(s) { gsub(/^ +| +$/, "", s); return s }
  function fail(text) { print text > "/dev/stderr"; failed = 1; exit 1 }
  function show(   k, v) {
    shown = NR
    for (k = 1; k <= n; ++k) {
      v = $at[name[k]]
      if (v !~ /^[-+]?[0-9.]+(e[-+]?[0-9]+)?$/)
        fail(name[k] " is " v " in row " NR - 1)
      printf "%s%.11g", (k > 1 ? " " : ""), v / scale[k]
    }
    print ""
  }
  NR == 1 {
    for (i = 1; i <= NF; ++i)
      at[$i] = i
    n = split(columns, name, ",")
    for (k = 1; k <= n; ++k) {
      scale[k] = 1
      if (match(name[k], / \/ [^ ]+ *$/)) {
        scale[k] = trim(substr(name[k], RSTART + 3)) + 0
        name[k] = substr(name[k], 1, RSTART - 1)
        if (scale[k] == 0) fail("scale of " name[k] " is no number")
      }
      name[k] = trim(name[k])
      if (!(name[k] in at)) fail("no column \"" name[k] "\"")
      printf "%s%s", (k > 1 ? "; " : "# "), name[k]
    }
    print ""
    every = rows ~ /^every [0-9]+$/ ? substr(rows, 7) + 0 : 0
    if (!every && rows != "last") fail("rows: " rows)
    next
  }
  every && (NR - 1) % every == 0 { show() }
  END {
    if (failed) exit 1
    if (NR < 2) fail("history.csv has no row")
    if (shown != NR) show()
  }' "$history" >"$work/compared" || fail "the columns cannot be compared"

reference=${scene%.prm}.output
if [[ ${ALVEOLUS_UPDATE-} == 1 && ${#launcher[@]} == 0 &&
  $(value reference result) != exact ]]; then
  cp "$work/compared" "$reference"
  echo "written: $reference"
  exit 0
fi
[[ -e $reference ]] || fail "there is no $reference; ALVEOLUS_UPDATE=1 writes it"

tolerance=$(value tolerance 1e-8)
if ((${#launcher[@]})); then
  larger=$(awk -v t="$tolerance" 'BEGIN { print (t > 1e-6 ? t : 1e-6) }')
  tolerance=$(value 'parallel tolerance' "$larger")
fi
absolute=$(awk -v t="$tolerance" 'BEGIN { print 1e-3 * t }')
"$numdiff" -q -r "$tolerance" -a "$absolute" "$reference" "$work/compared" || {
  "$numdiff" -r "$tolerance" -a "$absolute" "$reference" "$work/compared" || true
  fail "results differ from $reference by more than $tolerance"
}
echo "equals $(basename "$reference") within $tolerance"
