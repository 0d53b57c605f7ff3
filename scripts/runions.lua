-- Every leaf of Runions et al. 2005, Table 1:  venule run scripts/runions.lua --set row=ginkgo -o ginkgo.png
-- Figures 9a to 9e:  --set row=search-kill-distance --set kill_distance=40 (20, 10, 5, 1)
-- Figures 9f to 9h:  --set row=search-density --set darts=60 (300, 6000)
-- Lengths are vein segments. The paper draws its outlines by hand; here they are chosen by its pictures' descriptions.
local venule = require "venule"
local leaf, growth = venule.leaf, venule.growth

local function marginal(from, to, step)
  return function(blade) return growth.marginal {domain = blade, origin = {0, 0}, from = from, to = to, step = step} end
end

-- Here the margin would outrun the veins 34 and 15 to 1, while the text has the tips follow it: divided by its step, it
-- advances by a segment a step. An inference of ours (READINGS R8), and the sizes then agree with the other rows.
local function slow(from, to, step) return marginal(from / step, to / step, 1) end

local function isogonic(from, to, step)
  return function(blade) return growth.isogonic {domain = blade, origin = {0, 0}, from = from, to = to, step = step} end
end

local function none(blade) return growth.none {domain = blade} end

-- From narrow to nearly round, as in figures/figure5.lua: eight times longer, most of it at the base, and wider still.
local function developmental(steps)
  return function(blade)
    return growth.rerg {
      domain = blade, steps = steps,
      x = function(y) return (14 + 12 * math.exp(-((y / 23 - 0.15) / 0.4) ^ 2)) ^ (1 / steps) end,
      y = function(y) return (6 + 6 * (1 - y / 23) ^ 2) ^ (1 / steps) end,
    }
  end
end

-- A toothed blade with one lobe: two blades about one petiole.
local function with_lobe()
  local turn, lobe = math.rad(-46), leaf.outline("toothed", {length = 0.46, width = 0.2, widest = 0.6, tip = "rounded", base = "cuneate", teeth = {{12, 0.014, 0.7}}})
  for i, p in ipairs(lobe) do
    lobe[i] = {p[1] * math.cos(turn) - p[2] * math.sin(turn), p[1] * math.sin(turn) + p[2] * math.cos(turn)}
  end
  return leaf.toothed {width = 0.52, tip = "acute", base = "cuneate", widest = 0.42, teeth = {{24, 0.008, 0.75}}} + venule.domain.polygon(lobe)
end

local ovate = leaf.entire {width = 0.8, widest = 0.32, tip = "acute"}
local rows = {
  -- pattern, kill distance, birth distance, growth (L_i, L_f, ΔL), darts · 10⁶, blade
  ["search-kill-distance"] = {"closed", 10, 10, marginal(270, 1600, 8), 600, ovate},   -- d_k is what varies
  ["search-density"] = {"closed", 1, 10, marginal(270, 1600, 8), 300, ovate},          -- ρ is what varies
  ["slow-marginal"] = {"open", 40, 1, slow(4500, 112000, 34), 300, ovate},             -- "similar to Figure 9b"
  ginkgo = {"open", 100, 1, slow(10, 50000, 15), 300, leaf.fan {spread = 120, notch = 0.05, wave = 0.008}, midvein = 0.006}, -- "rounded, tangentially expanding"
  alchemilla = {"open", 10, 1, marginal(3200, 4500, 9), 200, leaf.reniform {teeth = {{46, 0.012, 0.6}}}},
  sweetgum = {"open", 1, 1, marginal(1200, 6700, 7), 200, leaf.digitate {}},           -- five pointed lobes
  toothed = {"closed", 1, 10, marginal(6600, 26000, 40), 10, with_lobe()},             -- "a toothed leaf with a lobe"
  tertiary = {"closed", 1, 1, marginal(3500, 24000, 60), 20, leaf.entire {width = 0.6}, draw = 3}, -- "the entire leaf"
  orchid = {"closed", 1, 10, none, 600, leaf.orchid {length = 6500}, midvein = 0.005},
  reticulate = {"closed", 1, 15, isogonic(225, 4500, 40.5), 200, leaf.entire {width = 0.45}},
  cherry = {"open", 30, 1, marginal(1100, 5500, 11), 40, leaf.toothed {width = 0.5, widest = 0.5, base = "cuneate", teeth = {{26, 0.012, 0.65}}}},
  grass = {"closed", 1, 30, none, 100, leaf.linear {length = 13000, width = 600, taper = 0.05}, seeds = 20,
    midvein = 0.0006, part = {0.3, 0.4}}, -- "a segment of a grass leaf", and "a row of initial vein nodes"
  poplar = {"closed", 1, 2, isogonic(115, 3500, 9), 200, leaf.poplar {}, draw = 1},
  developmental = {"closed", 1, 3, developmental(100), 5000, leaf.entire {length = 23, width = 6, tip = "rounded"}, exponent = 3, draw = 3},
  trillium = {"closed", 1, 30, none, 100, leaf.petal {length = 4500}},
}

local names = {}
for name in pairs(rows) do names[#names + 1] = name end
table.sort(names)

local p = venule.param {
  {"row", "cherry", choices = names, help = "of Table 1"},
  {"kill_distance", 0, min = 0, max = 200, help = "a vein this close consumes its source; 0: the table's"},
  {"darts", 0, min = 0, max = 1e5, unit = "darts/length² · 1e-6", help = "sources that are tried per area; 0: the table's"},
  {"neighborhood", "relative", choices = {"relative", "urquhart"}, help = "of closed patterns; Figure 18 compares them"},
  {"midvein", 0, min = 0, max = 0.1, help = "its width, of the blade's length; 0: the row's, or 0.01"},
  {"from", 0, min = 0, max = 0.99, help = "where the picture begins, of the blade's length; 0: the row's, or all of it"},
  {"to", 1, min = 0.01, max = 1, help = "where it ends"},
  {"size", 1000, min = 50, max = 8000, unit = "pixels", help = "of the picture's longer side"},
}

local row = rows[p.row]
local pattern, kill_distance, birth_distance, grow, darts, shape = table.unpack(row)
local blade = grow(shape)

local system = venule.venation {
  domain = blade,
  rng = venule.rng(p.seed + (row.draw or 0)), -- by chance some midveins fork at their foot: not in these draws
  roots = row.seeds and leaf.base(blade, row.seeds) or {{0, 0}},
  darts = 1e-6 * (p.darts > 0 and p.darts or darts),
  birth_distance = birth_distance,
  kill_distance = p.kill_distance > 0 and p.kill_distance or kill_distance,
  neighborhood = pattern == "closed" and p.neighborhood or "nearest",
}
system:run()

-- At exponent 2 a midvein is √tips as wide as a tip: choose the tip's width by the midvein's (READINGS R7).
local veins, bounds = system.network, blade:bounds()
local length = bounds.max[2] - bounds.min[2]
local exponent, midvein = row.exponent or 2, p.midvein > 0 and p.midvein or row.midvein or 0.01
veins:murray {exponent = exponent, tip_radius = 1}
veins:murray {exponent = exponent, tip_radius = midvein / 2 * length / veins:measure().max_radius}
veins:orders "hickey"

local part = (p.from > 0 or p.to < 1) and {p.from, p.to} or row.part
if part then -- of the blade's length is in the picture
  bounds = {min = {bounds.min[1], part[1] * length}, max = {bounds.max[1], part[2] * length}}
end
local is_wide = bounds.max[1] - bounds.min[1] > bounds.max[2] - bounds.min[2]

venule.result {
  network = veins,
  width = is_wide and p.size or nil,
  height = not is_wide and p.size or nil,
  view = bounds,
  margin = 24,
  background = "#fdfcf7",
  picture = function(page)
    page:fill(blade, {color = "#dfe9c8", stroke = "#8aa36a", line_width = 2 / page.scale})
    page:stroke(veins, {color = "#3d5c2b", min_width = 0.5})
  end,
}
