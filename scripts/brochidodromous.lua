-- A leaf of arches, as of Ficus or Eucalyptus, which Runions et al. 2005 leave open:  venule run scripts/brochidodromous.lua
-- Secondaries joined in arches, tertiaries and finer veins by the closed algorithm, and veinlets that end freely.
local venule = require "venule"

local p = venule.param {
  {"secondaries", 12, min = 2, max = 60, help = "at each side"},
  {"length", 600, min = 100, max = 5000, unit = "vein segments", help = "of the blade"},
  {"width", 0.42, min = 0.1, max = 1.2, help = "of the blade, by its length"},
  {"rise", 0.1, min = 0, max = 0.5, help = "how far secondaries climb toward the tip, of the length"},
  {"reach", 0.82, min = 0.3, max = 0.95, help = "how near the margin the arches come"},
  {"veinlets", "yes", choices = {"yes", "no"}, help = "that end freely within the areoles"},
  {"size", 1200, min = 50, max = 8000, unit = "pixels", help = "height of the picture"},
}

local blade = venule.leaf.entire {length = p.length, width = p.width * p.length, widest = 0.48, tip = "acuminate", base = "cuneate"}
local rng = venule.rng(p.seed)
local veins = venule.brochidodromous {domain = blade, rng = rng, secondaries = p.secondaries, rise = p.rise, reach = p.reach}.network

-- The arches carry little at first and are drawn as wide as secondaries are: a copy keeps them apart from what comes.
local function copy(from)
  local to, x, y, parent = venule.network {}, from.x, from.y, from.parent
  for i = 1, #from do
    if parent[i] == 0 then to:root(x[i], y[i]) else to:add(parent[i], x[i], y[i]) end
  end
  for _, join in ipairs(from:joins()) do to:join(join.a, join.b) end
  to:murray {exponent = 2, tip_radius = 1}
  to:murray {exponent = 2, tip_radius = 0.0045 * p.length / to:measure().max_radius}
  return to
end

local main = copy(veins)

-- Tertiaries, then what divides them.
for _, distance in ipairs {0.03 * p.length, 0.012 * p.length} do
  venule.venation {
    domain = blade, network = veins, rng = rng, neighborhood = "relative", birth_distance = distance, darts = 0.2 / distance ^ 2,
  }:run()
end
if p.veinlets == "yes" then venule.veinlets {network = veins, domain = blade, rng = rng, birth_distance = 0.012 * p.length, segment_length = 1} end

veins:murray {exponent = 2, tip_radius = 1}
veins:murray {exponent = 2, tip_radius = 0.0045 * p.length / veins:measure().max_radius}
veins:orders "hickey"

venule.result {
  network = veins,
  height = p.size,
  view = blade:bounds(),
  margin = 24,
  background = "#fdfcf7",
  picture = function(page)
    page:fill(blade, {color = "#dfe9c8", stroke = "#8aa36a", line_width = 2 / page.scale})
    page:stroke(veins, {color = "#3d5c2b", min_width = 0.5})
    page:stroke(main, {color = "#3d5c2b"})
  end,
}
