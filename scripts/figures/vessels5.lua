-- Rauch & Harders 2021, Figure 5: one disk, five times. a: arteries, b: the same with the veins that grew along; c: a larger κ
-- widens the angles, d: a larger ω straightens, e: a larger φ gives laterals in place of forks. a, c, d and e show arteries alone.
local venule = require "venule"
local pen = require "pen"

local p = venule.param {
  {"steps", 100, min = 1, max = 5000, help = "how many; the disk grows in each"},
  {"murray_exponent", 3.6, min = 2.01, max = 4, help = "κ of c; else 2.55"},
  {"bias", 0.9, min = 0, max = 1, help = "ω of d; else 0.5"},
  {"bifurcation_threshold", 30.0, min = 0, max = 180, unit = "degrees", help = "φ of e; else 15"},
  {"size", 2000, min = 100, max = 16000, unit = "pixels", help = "width of the picture"},
}

local disk = venule.domain.disk {radius = 0.5}

local function grow(change)
  local o = {
    domain = disk, rng = venule.rng(p.seed), steps = p.steps, segment_length = 0.022,
    arteries = {roots = {{-0.5, 0}}}, veins = {roots = {{-0.49, -0.09}}, perception_distance = 0.1},
  }
  for name, value in pairs(change) do o[name] = value end
  return venule.vessels(o):run()
end

local panels = {
  {"a", "arteries", {}},
  {"b", "and veins", {}, veins = true},
  {"c", ("κ = %g"):format(p.murray_exponent), {murray_exponent = p.murray_exponent}},
  {"d", ("ω = %g"):format(p.bias), {bias = p.bias}},
  {"e", ("φ = %g°"):format(p.bifurcation_threshold), {bifurcation_threshold = p.bifurcation_threshold}},
}
for i, panel in ipairs(panels) do
  panel.system = i == 2 and panels[1].system or grow(panel[3])
  venule.frame(i / #panels)
end

local function draw(page, i)
  local panel, column, row = panels[i], (i - 1) % 3, (i - 1) // 3
  local here, s = pen.at(page, 1.08 * column + 0.54 * row, -1.14 * row), panel.system
  local law = {exponent = panel[3].murray_exponent or 2.55, tip_radius = 0.0005 * s.unit}
  here:text(panel[1], -0.48, 0.44, p.size / 50)
  here:text(panel[2], -0.48, -0.52, p.size / 70, "start")
  if panel.veins then here:network(s.veins, law, {color = "#3f6aa8", min_width = 0.45}) end
  here:network(s.arteries, law, {color = "#c23b2e", min_width = 0.45})
end

venule.result {
  networks = panels[2].system.networks, width = p.size, background = "#ffffff", view = {min = {-0.56, -1.7}, max = {2.72, 0.54}},
  picture = function(page)
    for i = 1, #panels do draw(page, i) end
  end,
}
