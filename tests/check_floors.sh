#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_floors.sh SOURCE_DIR: fails if a file includes a header of a floor above
# its own, or of a floor it must not know. See CONTRIBUTING.md.
set -euo pipefail
cd "${1:?usage: check_floors.sh SOURCE_DIR}"

# Input: lines "path:number:#include <alveolus/floor/file.h>"
violations()
{
  awk '
    BEGIN {
      n = split("base algebra geometry mesh materials remodelling state " \
                "assembly solver rezoning transfer remeshing io scene driver", \
                floors)
      for (i = 1; i <= n; ++i)
        level[floors[i]] = i
      # What may not be included although it is lower
      forbid("geometry", "algebra")
      forbid("materials", "algebra geometry mesh")
      forbid("remodelling", "algebra geometry mesh")
      forbid("rezoning", "materials remodelling assembly solver")
      forbid("transfer", "materials remodelling assembly solver rezoning")
      forbid("remeshing",
             "materials remodelling assembly solver rezoning transfer")
    }
    function forbid(floor, list,   names, i, m) {
      m = split(list, names, " ")
      for (i = 1; i <= m; ++i)
        forbidden[floor, names[i]] = 1
    }
    {
      path = $0
      sub(/:.*/, "", path)
      m = split(path, part, "/")
      own = part[m - 1]
      included = $0
      sub(/.*alveolus\//, "", included)
      sub(/\/.*/, "", included)
      if (!(own in level))
        print path ": the floor " own " is not known to check_floors.sh"
      else if (!(included in level))
        print $0 ": there is no floor " included
      else if (level[included] > level[own] || (own, included) in forbidden)
        print $0 ": " own " must not include " included
    }'
}

# The check must find what it is made for.
[[ $(violations <<'END' | wc -l
source/mesh/a.cc:1:#include <alveolus/state/b.h>
include/alveolus/transfer/a.h:1:#include <alveolus/materials/b.h>
source/upper/a.cc:1:#include <alveolus/base/b.h>
source/state/a.cc:1:#include <alveolus/mesh/b.h>
source/remodelling/a.cc:1:#include <alveolus/materials/b.h>
END
) == 3 ]] || { echo "check_floors.sh does not find violations" >&2; exit 1; }

includes=$(grep -rnE '^ *# *include *[<"]alveolus/' source/*/ include/alveolus/ \
  --include='*.h' --include='*.cc')
[[ $includes ]] || { echo "no includes found in $PWD" >&2; exit 1; }
found=$(violations <<<"$includes")
if [[ $found ]]; then
  printf '%s\n' "$found"
  exit 1
fi
echo "$(wc -l <<<"$includes") includes respect the floors"
