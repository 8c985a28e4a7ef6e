#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# run_validate.sh ALVEOLUS WORK_DIR
#
# What --validate says of optional parts and of cost, for a scene that needs
# none of them, one with most of them, and one with contact.
set -euo pipefail
program=$1 work=$2
cd "$(dirname "$0")/../.."
rm -rf "$work"
mkdir -p "$work"

fail() { echo "FAILED: $*" >&2; exit 1; }

# said NAME REGEX: the line must be among what was said of the scene
said() { grep -Eqx -e " *$2" "$work/$1.txt" ||
  { cat "$work/$1.txt"; fail "$1: no line '$2'"; }; }

validate() # NAME SCENE
{
  "$program" --validate --output "$work/$1" "$2" >"$work/$1.txt" ||
    fail "$2: exit code $?"
  [[ ! -e $work/$1/history.csv ]] || fail "$2: it was solved"
}

# Elastic and Lagrangian on 16 x 16 cells: two unknowns at 17 x 17 nodes. Of the
# 16 x 17 free nodes (3*16-2)*(3*17-2) pairs are neighbours, four entries each;
# the 34 unknowns that are held keep their diagonal. Four strains, twice, at
# four points, eight bytes each.
validate elastic prm/verification/cook-membrane-plane-strain.prm
said elastic 'region .*256 bytes of history per cell'
said elastic 'cost +578 unknowns, 9050 nonzeros in the matrix \(15\.7 a row\)'
said elastic 'off +plasticity, remodelling, fabric, mean dilatation, interface, contact, rezoning, transfer of history, reference map, remeshing'
said elastic 'on +records: tip'
said elastic 'memory: matrix .*, its factors about .*, history 0\.1 MB, .*'

validate academic prm/academic.prm
said academic 'on +plasticity: bone'
said academic 'on +remodelling: bone by mechanostat'
said academic 'on +mean dilatation: bone'
said academic 'on +interface: tooth'
said academic 'on +rezoning: 6 rules'
said academic 'on +transfer of history: Godunov \(first order\)'
said academic 'on +fields: every 36 T'
said academic 'off +contact, reference map, remeshing, records'

validate contact prm/verification/contact-patch.prm
said contact 'on +contact: contact'
