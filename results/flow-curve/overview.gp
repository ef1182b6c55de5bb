# Draws overview.png, three flow curves with 95 % error bars, from table.csv: gnuplot results/flow-curve/overview.gp
here = ARG0[1:strstrt(ARG0, 'overview.gp') - 1]
table = here . 'table.csv'
set terminal pngcairo size 1000, 460 font 'Sans,15' linewidth 1.5
set output here . 'overview.png'
set datafile separator comma
set datafile missing NaN
set key autotitle columnhead

# Rows of the curves: the default method, 250 spheres and the contact stiffness of the published table.
taken(phi) = strcol('method') eq 'implicit' && column('count') == 250 && column('stiffness') == 1e4 && column('fraction') == phi
eta(phi) = taken(phi) ? column('viscosity') : NaN
# Student's t for 95 % and the seeds of the row, 16 or 8.
half_width(phi) = column('viscosity_error') * (column('seeds') == 16 ? 2.131 : column('seeds') == 8 ? 2.365 : NaN)

set logscale xy
set xrange [5e-3:2e4]
set yrange [3:130]
set format x '10^{%L}'
set ytics (3, 5, 10, 20, 50, 100)
set grid lc rgb '#d0d0d0'
set border 3
set tics nomirror
set xlabel 'Péclet number Pe (shear over Brownian motion)'
set ylabel 'relative viscosity η_r'
set encoding utf8
set key top right reverse Left samplen 2 noautotitle

colour(n) = word('#1f77b4 #d95f02 #2a9d4a', n)
phi(n) = 0.40 + 0.05 * n
plot for [n=3:1:-1] table using 'peclet':(eta(phi(n))) smooth unique with lines lc rgb colour(n) notitle, \
  for [n=3:1:-1] table using 'peclet':(eta(phi(n))):(half_width(phi(n))) with yerrorbars pt 7 ps 1.1 lc rgb colour(n) \
    title sprintf('volume fraction φ = %.2f', phi(n))
