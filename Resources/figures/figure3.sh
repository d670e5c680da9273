#!/usr/bin/env bash
# Reproduces figure 3 of the paper: an oblique view of a cube whose scalar is the z index, with an edge of 1 mm
# and of 512 mm, under its conditions (--paper), and with an exact surface. Writes section "figure3" of README.md. usage: bash Resources/figures/figure3.sh
source "$(dirname "${BASH_SOURCE[0]}")/figures.sh"
page=$out/figure3.md

# plot_surface NAME MM: plots the clipping surface $out/NAME.ply from the camera and turned by 90 degrees about the
# vertical axis of the image, colored by depth.
plot_surface() {
  local name=$1 mm=$2 header count
  header=$(($(grep -abo -m1 end_header "$out/$name.ply" | cut -d: -f1) + 11))
  count=$(grep -a -m1 'element vertex' "$out/$name.ply" | cut -d' ' -f3)
  # The mesh has large triangles where the surface is flat, so each triangle is filled with points.
  awk -v spacing="$(bc -l <<<"$mm / 130")" '
    function distance(a, b) { return sqrt((x[a] - x[b]) ^ 2 + (y[a] - y[b]) ^ 2 + (z[a] - z[b]) ^ 2) }
    function greater(a, b) { return a > b ? a : b }
    NF == 4 { x[n] = $1; y[n] = $2; z[n] = $3; depth[n++] = $4 }
    NF == 13 {
      for (i = 0; i < 3; ++i)
        v[i] = $(4 * i + 2) + 256 * ($(4 * i + 3) + 256 * $(4 * i + 4))
      longest = greater(distance(v[0], v[1]), greater(distance(v[1], v[2]), distance(v[2], v[0])))
      steps = int(longest / spacing) + 1
      for (i = 0; i <= steps; ++i)
        for (j = 0; i + j <= steps; ++j) {
          a = i / steps; b = j / steps; c = 1 - a - b
          print a * x[v[0]] + b * x[v[1]] + c * x[v[2]], a * y[v[0]] + b * y[v[1]] + c * y[v[2]],
            a * z[v[0]] + b * z[v[1]] + c * z[v[2]], a * depth[v[0]] + b * depth[v[1]] + c * depth[v[2]]
        }
    }' <(od -An -v -w16 -tf4 -j "$header" -N $((16 * count)) "$out/$name.ply") \
    <(od -An -v -w13 -tu1 -j $((header + 16 * count)) "$out/$name.ply") >"$out/$name.points"
  # Right and up directions of the view: the camera of the cube's scene, which the stats do not contain.
  gnuplot <<END
set terminal pngcairo size 1000,430 font 'DejaVu Sans,11' background '#181818'
set output '$out/$name-plot.png'
set border lc rgb 'white'; set tics textcolor rgb 'white'; set key off
set style fill solid; set palette rgbformulae 33,13,10
set xlabel textcolor rgb 'white'; set ylabel textcolor rgb 'white'; set cblabel 'depth, mm' textcolor rgb 'white'
bx = 1.33547; by = -2.96772; bz = -1.18709; l = sqrt(bx*bx + by*by + bz*bz)
fx = bx/l; fy = by/l; fz = bz/l
ux = 0.140625; uy = -0.312499; uz = 0.939451
rx = fy*uz - fz*uy; ry = fz*ux - fx*uz; rz = fx*uy - fy*ux
set multiplot layout 1,2
set size ratio -1
set title 'd  from the camera' textcolor rgb 'white'
set xlabel 'right, mm'; set ylabel 'up, mm'
plot '$out/$name.points' using (\$1*rx+\$2*ry+\$3*rz):(\$1*ux+\$2*uy+\$3*uz):4 with points pt 5 ps 0.35 palette
set title 'd  turned by 90 degrees' textcolor rgb 'white'
set xlabel 'depth, mm' offset 0,-0.5; set ylabel 'up, mm'; set xtics rotate by -60
plot '$out/$name.points' using 4:(\$1*ux+\$2*uy+\$3*uz):4 with points pt 5 ps 0.35 palette
unset multiplot
END
}

cat >"$page" <<'END'
## Figure 3 of the paper

Written by `figure3.sh`: a cube of 512³ voxels whose scalar is the z index, from -255 (blue) to 255 (red). The focus is a
cuboid of 255 × 255 × 391 voxels in its center. The paper's "unit cube" has an edge of 1 without a unit, but smoothing with
p = 0.5 depends on the unit. So the figure has two versions, with edges of 1 mm and 512 mm. All images use `--paper`, the
conditions of the paper; those of `exact` differ in `--clip-boundary exact` alone.
END
for mm in 1 512; do
  make_phantom cube "cube-$mm" --edge "$mm"
  cube=("$out/cube-$mm/cube.mrml" --focus Focus --paper --background dark)
  render "cube$mm-plane" "${cube[@]}" --clip plane
  render "cube$mm-cutaway" "${cube[@]}" --clip cutaway
  render "cube$mm-spline" "${cube[@]}"
  render "cube$mm-exact" "${cube[@]}" --clip-boundary exact
  for boundary in spline exact; do
    "$fenestra" "${cube[@]}" --clip-boundary "$boundary" --size 256x256 --samples 1 --quiet \
      --surface "$out/cube$mm-$boundary.ply" --output "$out/surface.png"
    plot_surface "cube$mm-$boundary" "$mm"
  done
  join_images "figure3-$mm.jpg" "cube$mm-plane" "a  Cut plane" "cube$mm-cutaway" "b  Cut-away" \
    "cube$mm-spline" "c  Clipping surface, spline" "cube$mm-exact" "c  Clipping surface, exact"
  for boundary in spline exact; do
    convert "$out/cube$mm-$boundary-plot.png" -quality 88 "$figures/figure3-$mm-$boundary.jpg"
  done
  {
    printf '\n**Edge of %s mm**: clips, clipping surface `spline`, clipping surface `exact`\n![a to c](figure3-%s.jpg)\n' "$mm" "$mm"
    printf '![d, spline](figure3-%s-spline.jpg)\n![d, exact](figure3-%s-exact.jpg)\n\n' "$mm" "$mm"
    echo "| clip | gap mm: mean | p95 | max | slope jump | focus kept | focus shown | light on the focus |"
    echo "|---|---|---|---|---|---|---|---|"
    for name in plane cutaway spline exact; do
      echo "| $name | $(get "cube$mm-$name" .boundaryGapMm.mean %.4f) | $(get "cube$mm-$name" .boundaryGapMm.p95 %.4f)" \
        "| $(get "cube$mm-$name" .boundaryGapMm.max %.4f) | $(get "cube$mm-$name" .boundarySlopeJump.mean)" \
        "| $(get "cube$mm-$name" .focusKept %.3f) | $(get "cube$mm-$name" .focusCoverage %.3f) | $(get "cube$mm-$name" .focusLight) |"
    done
  } >>"$page"
done
cat >>"$page" <<'END'

- The visible side of the focus has three faces that meet in edges, so its outline is not planar. A plane cuts off parts of
  the focus, and the thin plate spline rounds the corners of the outline.
- At 1 mm, λ = (1 − p) / p = 1 is huge compared to the shape: the spline is close to the least-squares plane and misses the
  outline by a noticeable fraction of the cube. At 512 mm it almost interpolates.
- "The continuity of the surface with the object boundary" in the paper's figure holds at a suitable size only. With
  `--clip-boundary exact` it holds at any size.
END
write_section figure3
