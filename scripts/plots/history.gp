# SPDX-License-Identifier: LGPL-2.1-or-later
# Every recorded quantity of a run against time, one panel each; counters and
# seconds are left out.
folder = ARG0[:strstrt(ARG0, "/history.gp") - 1]
load folder."/common.gp"
file = csv(name)
header = system("head -n 1 '".file."' | tr ',' '\\n' | awk '{ gsub(/ /, \"~\") } !/^time~|\\[s\\]$|iterations|attempts|^points~|limited|inverted/ { printf \"%s \", $0 }'")
n = words(header)
if (n == 0) { print "figures: ".file." has no quantity to draw"; exit status 2 }
plain(i) = system("printf %s '".word(header, i)."' | tr '~' ' '")
n_columns = n > 3 ? 3 : n
n_rows = (n + n_columns - 1) / n_columns
set terminal pngcairo size 1800,n_rows * 420 + 60 font "DejaVu Sans,15" linewidth 2.5 background "white"
set output root."/figures/".name."-history.png"
set multiplot layout n_rows,n_columns title name noenhanced
unset key
set xlabel "time [T]"
set format y "%.4g"
do for [i = 1:n] {
  quantity = plain(i)
  set title quantity noenhanced
  plot file using (column("time [T]")):(column(quantity)) lt 1 notitle
}
unset multiplot
