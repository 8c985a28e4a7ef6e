# SPDX-License-Identifier: LGPL-2.1-or-later
# Counterpart of the paper's Figure 2: the uniaxial test of Table 2 with the
# three readings of it (scene verification/ligament-uniaxial).
folder = ARG0[:strstrt(ARG0, "/incisor-2") - 1]
load folder."/common.gp"
set output root."/figures/incisor-2-ligament.png"
pulled(run) = csv("ligament-".run."-tension")
pressed(run) = csv("ligament-".run."-compression")
set multiplot layout 1,2 margins 0.08,0.98,0.11,0.93 spacing 0.1
set xlabel "engineering strain [-]"
set ylabel "engineering stress [MPa]"
# The integral of Table 2
table(e) = e < -0.31 ? table1(-0.31) + 8.5*(e + 0.31) : table1(e)
table1(e) = e < -0.25 ? table2(-0.25) + (e + 0.25)*(0.68 + 0.5*7.82*(e + 0.25)/(-0.06)) : table2(e)
table2(e) = e < 0 ? 0.068*e - 0.5*0.612*e*e/0.25 : e < 0.14 ? 0.068*e + 0.5*1.282*e*e/0.14 : 0.09926 + 8.5*(e - 0.14)
set title "Compression and tension"
set xrange [-0.36:0.6]
set yrange [-2.5:4]
set key bottom right font ",16" samplen 2
plot table(x) lt -1 dt 3 title "Table 2", \
     pulled("valanis-landel") using (0.6*column("time [T]")):"top: force z [N]" lt 1 title "Valanis-Landel", \
     pressed("valanis-landel") using (-0.8*column("time [T]")):"top: force z [N]" lt 1 notitle, \
     pulled("hypoelastic") using (0.6*column("time [T]")):"top: force z [N]" lt 2 title "hypoelastic", \
     pressed("hypoelastic") using (-0.8*column("time [T]")):"top: force z [N]" lt 2 notitle, \
     pulled("hencky") using (0.6*column("time [T]")):"top: force z [N]" lt 3 title "Hencky with tabulated pressure", \
     pressed("hencky") using (-0.8*column("time [T]")):"top: force z [N]" lt 3 notitle
set title "Small strains"
set xrange [-0.2:0.14]
set yrange [-0.06:0.1]
unset key
replot
unset multiplot
