# SPDX-License-Identifier: LGPL-2.1-or-later
# gnuplot -e "data='doc/peers'" scripts/plots/peers.gp: force curves of Alveolus
# and CalculiX (scripts/peers/calculix.py) and how far they are apart.
set datafile separator ","
set terminal pngcairo size 1000,420 font "sans,11"
set output data."/calculix.png"
set grid
set xlabel "travel of the tooth [mm]"
set multiplot layout 1,2
set key top left
set ylabel "force [kN/mm]"
plot data."/calculix-elastic-force.csv" skip 1 using 1:($2/1e3) with lines lw 2 title "Alveolus, elastic", \
     '' skip 1 using 1:($3/1e3) every 5 with points pt 6 title "CalculiX, elastic", \
     data."/calculix-force.csv" skip 1 using 1:($2/1e3) with lines lw 2 title "Alveolus, elastoplastic", \
     '' skip 1 using 1:($3/1e3) every 5 with points pt 8 title "CalculiX, elastoplastic"
set ylabel "CalculiX / Alveolus - 1 [%]"
set yrange [-1:1]
plot data."/calculix-elastic-force.csv" skip 1 using 1:(100*($3/$2-1)) with lines lw 2 title "elastic", \
     data."/calculix-force.csv" skip 1 using 1:(100*($3/$2-1)) with lines lw 2 title "elastoplastic"
unset multiplot
