-- Figure 20: a leaf develops by growth that is neither uniform nor isotropic (Figure 5): veins come in succession, from low
-- order to high. Left: the second order comes, in the early stages. Right: the high orders, in another leaf. The stages are
-- drawn equally high; the last row of Table 1 but one, with n = 3.
local venule = require "venule"
local pen = require "pen"

local p = venule.param {
  {"steps", 100, min = 20, max = 2000, help = "of growth, from 23 to 184 segments"},
  {"vein_steps", 1, min = 1, max = 20, help = "to each of them"},
  {"darts", 5000, min = 1, max = 1e5, unit = "darts/length² · 1e-6", help = "a step"},
  {"birth_distance", 3.0, min = 0.5, max = 30, unit = "segments", help = "sources keep this far from each other and from veins"},
  {"other", 11, min = 0, max = 1e6, help = "added to the seed for the leaf at the right; 3 is the one at the left"},
  {"size", 2000, min = 200, max = 8000, unit = "pixels", help = "width of the picture"},
}

local LENGTH, WIDTH = 23, 6
local outline = venule.leaf.outline("entire", {length = LENGTH, width = WIDTH, tip = "rounded"})

-- The leaf as it is now, 100 high, with its left side at x.
local function snapshot(blade, net, left)
  local scale, points, half = 100 / blade.length, {}, 0
  for i, q in ipairs(outline) do
    local px, py = blade:map(q[1], q[2], 0, blade.time)
    points[i] = {scale * px, scale * py}
    half = math.max(half, scale * px)
  end
  local x = left + half
  local veins, nx, ny, parent = venule.network {}, net.x, net.y, net.parent
  local index = {}
  local function add(i)
    if index[i] then return index[i] end
    local at = parent[i]
    index[i] = at == 0 and veins:root(x + scale * nx[i], scale * ny[i]) or veins:add(add(at), x + scale * nx[i], scale * ny[i])
    return index[i]
  end
  for i = 1, #net do add(i) end
  for _, join in ipairs(net:joins()) do veins:join(add(join.a), add(join.b)) end
  veins:murray {exponent = 3, tip_radius = 1}
  veins:murray {exponent = 3, tip_radius = 0.9 / veins:measure().max_radius}
  return {veins = veins, outline = points, x = x, right = x + half, length = blade.length}
end

local leaves, right, network = {}, 0, nil

-- A leaf of its own, drawn when it has each of these lengths; with the last, it is done.
local function develop(draw, stages)
  local blade = venule.growth.rerg {
    domain = venule.domain.polygon(outline), origin = {0, 0}, steps = p.steps,
    x = function(y) return (14 + 12 * math.exp(-((y / LENGTH - 0.15) / 0.4) ^ 2)) ^ (1 / p.steps) end,
    y = function(y) return (6 + 6 * (1 - y / LENGTH) ^ 2) ^ (1 / p.steps) end,
  }
  local system = venule.venation {
    domain = blade, rng = venule.rng(p.seed + draw), roots = {{0, 0}}, birth_distance = p.birth_distance,
    kill_distance = 1, darts = 1e-6 * p.darts, neighborhood = "relative", vein_steps = p.vein_steps,
  }
  local due, grown = 1, 8 * LENGTH - 1e-6
  network = system.network
  repeat
    local more = system:step()
    if blade.length >= stages[due] - 1e-6 and (stages[due] < grown or not more) then
      leaves[#leaves + 1] = snapshot(blade, network, right + 12)
      right, due = leaves[#leaves].right, due + 1
    end
    venule.frame()
  until due > #stages or not more
end

develop(3, {28, 36, 50, 75})
right = right + 12
develop(p.other, {110, 150, 184})

venule.result {
  network = network, width = p.size, background = "#fdfcf7", view = {min = {0, -14}, max = {right + 12, 104}},
  picture = function(page)
    for _, leaf in ipairs(leaves) do
      local here = pen.at(page, leaf.x, 0)
      here:fill(leaf.outline, {color = "#dfe9c8", stroke = "#8aa36a", line_width = 0.3})
      page:stroke(leaf.veins, {color = "#3d5c2b", min_width = 0.4})
      here:text(("%.0f long"):format(leaf.length), 0, -9, 18)
    end
  end,
}
