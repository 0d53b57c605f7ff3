-- Rauch & Harders 2021, Figure 6: what parameters do that do not fit. Left: d is so large that vessels overshoot their drains and
-- run into others; middle: γ is so large that they turn back on themselves; right: with ω near 1 they run straight past their
-- drains. Each run says so in a note.
local venule = require "venule"
local pen = require "pen"

local p = venule.param {
  {"segment_length", 0.09, min = 1e-4, max = 1, unit = "diameters", help = "d on the left; else 0.022"},
  {"perception_angle", 340.0, min = 1, max = 360, unit = "degrees", help = "γ in the middle; else 90"},
  {"bias", 0.98, min = 0, max = 1, help = "ω on the right; else 0.5"},
  {"steps", 60, min = 1, max = 1000, help = "of growth"},
  {"size", 2100, min = 100, max = 16000, unit = "pixels", help = "width of the picture"},
}

local panels = {
  {("d = %g"):format(p.segment_length), {segment_length = p.segment_length}},
  {("γ = %g°"):format(p.perception_angle), {perception_angle = p.perception_angle}},
  {("ω = %g"):format(p.bias), {bias = p.bias}},
}
for i, panel in ipairs(panels) do
  local o = {
    domain = venule.domain.disk {radius = 0.5}, rng = venule.rng(p.seed), steps = p.steps, segment_length = 0.022,
    arteries = {roots = {{-0.5, 0}}},
  }
  for name, value in pairs(panel[2]) do o[name] = value end
  panel.system = venule.vessels(o):run()
  venule.frame(i / #panels)
end

venule.result {
  network = panels[1].system.arteries, width = p.size, background = "#ffffff", view = {min = {-0.54, -0.62}, max = {2.7, 0.54}},
  picture = function(page)
    for i, panel in ipairs(panels) do
      local here = pen.at(page, 1.08 * (i - 1), 0)
      here:circle(0, 0, 0.5, "#dcdcdc", 0.003)
      here:network(panel.system.arteries, {exponent = 2.55, tip_radius = 0.0005 * panel.system.unit}, {color = "#c23b2e", min_width = 1})
      here:text(panel[1], 0, -0.58, p.size / 60)
    end
  end,
}
