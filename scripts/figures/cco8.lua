-- Kerautret et al. 2023, Figure 8 b and c: diameters at each bifurcation level, mean and deviations over ten trees. They fall
-- steeply over the first levels and flatten out: deep down all vessels are nearly terminals. `--set dim=2` is c.
local venule = require "venule"

local p = venule.param {
  {"dim", 3, min = 2, max = 3, help = "a ball (b) or a disk (c)"},
  {"terminals", 1000, min = 2, max = 1000000, help = "ends of each tree"},
  {"trees", 10, min = 1, max = 1000, help = "over which means are taken"},
  {"size", 1200, min = 100, max = 8000, unit = "pixels", help = "width of the picture"},
}

-- Diameters of the segments of each level, of all trees.
local levels = {}

local function collect(tree, node, level)
  local children = tree:children(node)
  for _, child in ipairs(children) do
    local below = #children > 1 and level + 1 or level
    local list = levels[below + 1] or {}
    list[#list + 1], levels[below + 1] = 2 * tree.radius[child], list
    collect(tree, child, below)
  end
end

local last
for k = 1, p.trees do
  local tree = venule.cco {dim = p.dim, terminals = p.terminals, seed = 1000 * p.seed + k}
  tree:run()
  last = tree.network
  collect(last, 1, 0)
  venule.frame(k / p.trees)
end

-- Few are far above the mean, most a little below: one deviation for both would reach below 0. So those above and those below
-- have their own.
local function spread(list, mean, side)
  local sum, count = 0, 0
  for _, d in ipairs(list) do
    if side * (d - mean) > 0 then sum, count = sum + (d - mean) ^ 2, count + 1 end
  end
  return count > 0 and math.sqrt(sum / count) or 0
end

local x, mean, above, below = {}, {}, {}, {}
for i, list in ipairs(levels) do
  local sum = 0
  for _, d in ipairs(list) do sum = sum + d end
  x[i], mean[i] = i - 1, sum / #list
  above[i], below[i] = spread(list, mean[i], 1), spread(list, mean[i], -1)
end

venule.result {
  network = last,
  picture = venule.plot {
    width = p.size, height = p.size * 0.6, text_size = p.size / 50, title = ("%d trees of %d terminals, %dD"):format(p.trees, p.terminals, p.dim),
    x = {label = "bifurcation level"}, y = {label = "diameter, mm", min = 0},
    series = {{x = x, y = mean, deviation = above, below = below, marks = true, color = "#b3201c", label = "mean, deviations above and below"}},
  },
}
