# SPDX-License-Identifier: LGPL-2.1-or-later
# Seconds of the parts of a Newton iteration against cells: scripts/benchmark
set terminal pngcairo size 900,420 font "sans,11"
set output data."/growth.png"
set logscale xy
set format y "10^{%L}"
set xlabel "cells"
set ylabel "processor seconds of a Newton iteration"
set key top left
set grid
set multiplot layout 1,2
do for [i=0:1] {
  set title sprintf("academic case, degree %d", i + 1)
  plot data."/growth.dat" index i using 1:2 with linespoints lw 2 pt 7 title "assembly", \
       '' index i using 1:3 with linespoints lw 2 pt 5 title "solution of the system", \
       '' index i using 1:4 with linespoints dt 2 pt 9 title "bare factorisation"
}
unset multiplot
