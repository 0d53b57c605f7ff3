-- Kerautret et al. 2023, Figure 8 b and c: diameters at each bifurcation level, mean and deviation over ten trees. They fall
-- steeply over the first levels and flatten out: deep down all vessels are nearly terminals. `--set dim=2` is c.
local venule = require "venule"

local p = venule.param {
  {"dim", 3, min = 2, max = 3, help = "a ball (b) or a disk (c)"},
  {"terminals", 1000, min = 2, max = 1000000, help = "ends of each tree"},
  {"trees", 10, min = 1, max = 1000, help = "over which means are taken"},
  {"size", 1200, min = 100, max = 8000, unit = "pixels", help = "width of the picture"},
}

-- Sums over all segments of a level, of all trees: how many, their diameters, and these squared.
local sums, last = {}, nil
for k = 1, p.trees do
  local tree = venule.cco {dim = p.dim, terminals = p.terminals, seed = 1000 * p.seed + k}
  tree:run()
  last = tree.network
  for i, level in ipairs(last:levels()) do
    local sum, d = sums[i] or {0, 0, 0}, level.diameter
    sums[i] = {sum[1] + level.count, sum[2] + level.count * d.mean, sum[3] + level.count * (d.deviation ^ 2 + d.mean ^ 2)}
  end
  venule.frame(k / p.trees)
end

local x, mean, deviation = {}, {}, {}
for i, sum in ipairs(sums) do
  x[i], mean[i] = i - 1, sum[2] / sum[1]
  deviation[i] = math.sqrt(math.max(sum[3] / sum[1] - mean[i] ^ 2, 0))
end

venule.result {
  network = last,
  picture = venule.plot {
    width = p.size, height = p.size * 0.6, text_size = p.size / 50, title = ("%d trees of %d terminals, %dD"):format(p.trees, p.terminals, p.dim),
    x = {label = "bifurcation level"}, y = {label = "diameter, mm", min = 0},
    series = {{x = x, y = mean, deviation = deviation, marks = true, color = "#b3201c", label = "mean and deviation"}},
  },
}
