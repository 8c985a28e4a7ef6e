# SPDX-License-Identifier: LGPL-2.1-or-later
# The slotted disc, cone and hump after one turn of the mesh: files rotation-*.dat
# of scripts/verify in the folder `root`, picture `name`.
set terminal pngcairo size 1500,800 font "DejaVu Sans,18" background "white"
set output name
set multiplot layout 2,3 margins 0.05,0.93,0.05,0.93 spacing 0.03,0.1
set size ratio -1
set xrange [0:1]
set yrange [0:1]
set cbrange [0:1]
unset xtics
unset ytics
set palette defined (0 "#ffffff", 0.25 "#c6dbef", 0.5 "#6baed6", 0.75 "#2171b5", 1 "#67001f")
unset key
unset colorbox
r(x, y, a, b) = sqrt((x-a)**2 + (y-b)**2)
disc(x, y) = r(x, y, 0.5, 0.75) < 0.15 ? (abs(x-0.5) >= 0.025 || y >= 0.85 ? 1 : 0) : 0
cone(x, y) = r(x, y, 0.5, 0.25) < 0.15 ? 1 - r(x, y, 0.5, 0.25)/0.15 : 0
hump(x, y) = r(x, y, 0.25, 0.5) < 0.15 ? 0.25*(1 + cos(pi*r(x, y, 0.25, 0.5)/0.15)) : 0
set title "start"
plot root."/rotation-swept-1.dat" using 1:2:(disc($1,$2)+cone($1,$2)+hump($1,$2)) with points pt 5 ps 0.35 lc palette
set title "same connectivity, order 1"
plot root."/rotation-swept-1.dat" using 1:2:3 with points pt 5 ps 0.35 lc palette
set title "same connectivity, order 2"
plot root."/rotation-swept-2.dat" using 1:2:3 with points pt 5 ps 0.35 lc palette
set multiplot next
set title "between meshes, order 1"
plot root."/rotation-overlap-1.dat" using 1:2:3 with points pt 5 ps 0.35 lc palette
set colorbox
set title "between meshes, order 2"
plot root."/rotation-overlap-2.dat" using 1:2:3 with points pt 5 ps 0.35 lc palette
unset multiplot
