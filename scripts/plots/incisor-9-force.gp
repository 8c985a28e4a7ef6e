# SPDX-License-Identifier: LGPL-2.1-or-later
# Counterpart of the paper's Figure 9: force against tip displacement; and the
# depth of the menisci.
folder = ARG0[:strstrt(ARG0, "/incisor-9") - 1]
load folder."/common.gp"
set output root."/figures/incisor-9-force.png"
set multiplot layout 1,2 margins 0.09,0.98,0.11,0.93 spacing 0.1
set title "Three runs"
set xlabel "displacement of the tip [mm]"
set ylabel "force [N per mm]"
set key top left
plot csv("incisor") using "tip: displacement [mm]":"applied force [N]" lt 1 title "ALE and remeshing", \
     csv("incisor-ale") using "tip: displacement [mm]":"applied force [N]" lt 2 dt 2 title "ALE", \
     csv("incisor-lagrangian") using "tip: displacement [mm]":"applied force [N]" lt 3 dt 4 title "Lagrangian"
set title "Menisci"
set xlabel "force [N per mm]"
set ylabel "depth of the free boundary [mm], outwards positive"
set key top left
plot csv("incisor") using "applied force [N]":"meniscus lingual: depth [mm]" lt 1 title "compressed side", \
     csv("incisor") using "applied force [N]":"meniscus labial: depth [mm]" lt 2 title "stretched side"
unset multiplot
