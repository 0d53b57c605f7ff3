-- Kerautret et al. 2023, Figure 3: what the tree is made of. Each terminal feeds a disc of the area A = perfusion / terminals;
-- between two forks there is one straight segment, thick enough for what it feeds.
local venule = require "venule"

local p = venule.param {
  {"terminals", 12, min = 2, max = 1000, help = "ends of the tree"},
  {"size", 1000, min = 50, max = 8000, unit = "pixels", help = "of the picture's sides"},
}

local tree = venule.cco {terminals = p.terminals, seed = p.seed}
tree:run()
local arteries, radius = tree.network, math.sqrt(20000 / p.terminals / math.pi)

local terminals, forks = {}, {}
for i = 1, #arteries do
  local list = #arteries:children(i) == 0 and terminals or #arteries:children(i) == 2 and forks or {}
  list[#list + 1] = {arteries.x[i], arteries.y[i]}
end

venule.result {
  network = arteries, view = tree.domain:bounds(), width = p.size, margin = p.size / 7, background = "#ffffff",
  picture = function(page)
    page:fill(tree.domain, {color = "#fdf6f3", stroke = "#b08a80"})
    for _, at in ipairs(terminals) do -- one by one, so that where two overlap is seen
      page:fill(venule.domain.disk {center = at, radius = radius}, {color = "#e0705f", opacity = 0.3, stroke = "#c8553d"})
    end
    page:stroke(arteries, {color = "#b3201c"})
    page:dots(terminals, {color = "#7a1512", radius = 0.9})
    page:dots(forks, {color = "#ffffff", radius = 0.6})
    page:text("p0", {at = {arteries.x[1] + 4, arteries.y[1] + 3}, size = p.size / 40, color = "#333333"})
  end,
}
