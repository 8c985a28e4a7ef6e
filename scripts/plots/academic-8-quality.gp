# SPDX-License-Identifier: LGPL-2.1-or-later
# Mesh quality, bone mass and what the mass balance leaves over.
folder = ARG0[:strstrt(ARG0, "/academic-8") - 1]
load folder."/common.gp"
set output root."/figures/academic-8-quality.png"
set multiplot layout 3,1 margins 0.13,0.97,0.08,0.94 spacing 0.06
set xrange [0:365]
set title "Mesh quality and bone mass"
set ylabel "scaled Jacobian,\nsmallest [-]"
set yrange [*:1]
set key bottom right
plot csv("academic") using "time [T]":"smallest scaled Jacobian" lt 1 title "ALE", \
     csv("academic-lagrangian") using "time [T]":"smallest scaled Jacobian" lt 2 dt 2 title "Lagrangian, until it stops"
unset title
set autoscale y
set ylabel "bone mass\n[mg per mm]"
set key top right
plot csv("academic") using "time [T]":"bone mass [mg]" lt 1 title "ALE", \
     csv("academic-lagrangian") using "time [T]":"bone mass [mg]" lt 2 dt 2 title "Lagrangian, until it stops"
set xlabel "time [T]"
set ylabel "|mass balance|\n[of initial mass]"
set logscale y
set format y "10^{%T}"
set yrange [1e-17:*]
plot csv("academic") using "time [T]":(abs(column("bone mass balance")) + 1e-17) lt 1 title "ALE"
unset multiplot
