-- Kerautret et al. 2023, Figure 9 a and b: seconds against terminals, in a disk or ball and in a domain of any shape: a mask
-- (`--set mask=FILE`, a picture or with dim=3 a volume), or else the outline of a leaf and the mesh of a liver. On logarithmic
-- axes a straight line is a power; slope 1 would be time in proportion to terminals. These are times of this machine.
local venule = require "venule"

local p = venule.param {
  {"dim", 2, min = 2, max = 3, help = "a or b"},
  {"mask", "", file = true, help = "the domain of any shape"},
  {"most", 16000, min = 1000, max = 10000000, help = "terminals of the largest tree"},
  {"size", 1000, min = 100, max = 8000, unit = "pixels", help = "width of the picture"},
}

local function any_shape()
  if p.mask ~= "" then return p.dim == 2 and venule.domain.image(p.mask) or venule.domain.volume(p.mask) end
  return p.dim == 2 and venule.domain.svg("../outlines/leaf-maple-autumn.svg", {pick = "largest"})
    or venule.domain.mesh("../data/liver.obj", {on = "inside"})
end

local counts = {}
for k = 0, 20 do
  local n = math.tointeger(250 * 2 ^ k)
  if n <= p.most then counts[#counts + 1] = n end
end

-- Flow makes no difference to the time, but little of it leaves room in any domain: radii go with its fourth root.
local function seconds(domain, k, name)
  local tree = venule.cco {dim = not domain and p.dim or nil, domain = domain, terminals = counts[k], inflow = 100, seed = p.seed}
  local started = os.clock()
  local whole = tree:run()
  local spent = os.clock() - started
  venule.note(("%s, %d terminals: %.2f s%s"):format(name, counts[k], spent, whole and "" or ", and full"))
  return spent, tree.network
end

local series, last = {}, nil
local shapes = {{p.dim == 2 and "disk" or "ball"}, {p.mask ~= "" and "mask" or p.dim == 2 and "leaf" or "liver mesh", any_shape()}}
for i, shape in ipairs(shapes) do
  local y = {}
  for k = 1, #counts do y[k], last = seconds(shape[2], k, shape[1]) end
  series[i] = {x = counts, y = y, label = shape[1], marks = true}
end

venule.result {
  network = last,
  picture = venule.plot {
    width = p.size, height = p.size * 0.7, text_size = p.size / 50, x = {label = "terminals", log = true},
    y = {label = "seconds", log = true}, series = series,
  },
}
