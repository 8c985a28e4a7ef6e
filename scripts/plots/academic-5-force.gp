# SPDX-License-Identifier: LGPL-2.1-or-later
# Counterpart of the paper's Figure 5: force and displacement against time.
folder = ARG0[:strstrt(ARG0, "/academic-5") - 1]
load folder."/common.gp"
set output root."/figures/academic-5-force.png"
set multiplot layout 2,1 margins 0.1,0.97,0.09,0.94 spacing 0.09
set xrange [0:365]
set ylabel "force on the tooth [kN per mm]"
set key bottom right
set title "Force and displacement of the tooth"
plot csv("academic") using "time [T]":(abs(column("force x [N]")) / 1e3) lt 1 title "ALE", \
     csv("academic-lagrangian") using "time [T]":(abs(column("force x [N]")) / 1e3) lt 2 dt 2 title "Lagrangian, until it stops", \
     csv("academic-no-remodelling") using "time [T]":(abs(column("force x [N]")) / 1e3) lt 3 title "ALE, without remodelling"
unset title
set key top left
set xlabel "time [T]"
set ylabel "displacement [mm]"
plot csv("academic") using "time [T]":"tooth displacement [mm]" lt 1 title "ALE", \
     csv("academic-lagrangian") using "time [T]":"tooth displacement [mm]" lt 2 dt 2 title "Lagrangian, until it stops", \
     csv("academic-no-remodelling") using "time [T]":"tooth displacement [mm]" lt 3 dt 3 title "ALE, without remodelling"
unset multiplot
