# SPDX-License-Identifier: LGPL-2.1-or-later
# Shared settings; columns of history.csv are addressed by their names.
set datafile separator ","
set datafile columnheaders
set terminal pngcairo size 1600,1100 font "DejaVu Sans,20" linewidth 2.5 background "white"
set grid lc rgb "#dddddd"
set border lc rgb "#444444"
set key top left Left reverse spacing 1.2 opaque
set style data lines
csv(run) = root."/".run."/history.csv"
set linetype 1 lc rgb "#b2182b"
set linetype 2 lc rgb "#2166ac"
set linetype 3 lc rgb "#4d9221"
