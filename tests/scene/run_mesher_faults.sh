#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# run_mesher_faults.sh ALVEOLUS WORK_DIR
#
# A mesher that is missing, crashes or hangs, at the start and at a remesh: the
# program ends with the code and the message that tell it, and in time; a run
# whose remesh fails keeps its mesh and goes on.
set -euo pipefail

program=$1 work=$2
cd "$(dirname "$0")/../.."
rm -rf "$work"
mkdir -p "$work/bin"

fail() { echo "FAILED: $*" >&2; exit 1; }

# In the place of gmsh; what it does to remeshes is told by a file.
echo none >"$work/remeshes"
real=$(command -v gmsh) || fail "there is no gmsh"
cat >"$work/bin/gmsh" <<END
#!/usr/bin/env bash
case \$1/\$(cat '$work/remeshes') in
  */*/remesh-*/crash) kill -SEGV \$\$ ;;
  */*/remesh-*/hang) sleep 600 ;;
esac
exec '$real' "\$@"
END
printf '#!/usr/bin/env bash\nkill -SEGV $$\n' >"$work/bin/crash"
printf '#!/usr/bin/env bash\nsleep 600\n' >"$work/bin/hang"
chmod +x "$work/bin/"*
PATH=$work/bin:$PATH

expect() # CODE PATTERN ARGUMENTS...
{
  local wanted=$1 pattern=$2 code=0
  shift 2
  "$program" --quiet --threads 1 "$@" >"$work/said" 2>&1 || code=$?
  [[ $code == "$wanted" ]] ||
    fail "exit code $code instead of $wanted: $(cat "$work/said")"
  [[ -z $pattern ]] || grep -Eqs -e "$pattern" "$work/said" \
    "$work/output/summary.json" || fail "no '$pattern': $(cat "$work/said")"
}

# At the start nothing is there to be kept.
mesh='Mesh/tooth in block'
for fault in 'no-such-program 2 could not be started' \
  'crash 1 crashed by signal 11' 'hang 1 did not end within its time limit'; do
  read -r name code message <<<"$fault"
  ALVEOLUS_MESHER=$name expect "$code" "the mesher '$name' $message" \
    --output "$work/start" --set "$mesh/Mesher time limit=0.5" \
    --validate prm/academic.prm
done

# At a remesh the old mesh is kept, which the log tells, and the run goes on. The
# tooth is meshed anew here, for which gmsh is needed.
kept() # MESSAGE ROWS
{
  grep -q "no mesh: .*$1" "$work/output/log.txt" &&
    grep -q 'the old mesh is kept' "$work/output/log.txt" ||
    fail "log.txt does not tell '$1'"
  (($(wc -l <"$work/output/history.csv") == $2 + 1)) ||
    fail "history.csv does not hold $2 rows"
}
echo crash >"$work/remeshes"
expect 0 '' --output "$work/output" --set Remeshing/Times=0.05 \
  --set Time/End=0.1 --set 'Time/Initial step=0.05' \
  --set 'Time/Maximum step=0.05' \
  --set 'Remeshing/outline/Smoothed regions=bone' \
  --set 'Remeshing/outline/Mesher time limit=0.3' prm/incisor.prm
kept 'crashed by signal 11' 2
echo hang >"$work/remeshes"
expect 0 '' --resume "$work/output" --accept-changes \
  --set Remeshing/Times=0.1 --set Time/End=0.15
kept 'did not end within its time limit' 3
echo "a missing, crashing or hanging mesher is told, and the run goes on"
