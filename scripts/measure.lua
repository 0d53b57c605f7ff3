-- What a network measures like, beside figures from nature:  venule run scripts/measure.lua --set file=tree.json -o angles.png
-- Without a file it is an arterial tree in a disk. The lines go to the terminal; the picture has angles, diameters by order, or
-- boxes, of this network and of what they are compared with.
local venule = require "venule"

local p = venule.param {
  {"file", "", help = "a network: .json, .xml, .vtp, .swc, .csv or .txt; left out: a tree in a disk"},
  {"terminals", 2000, min = 2, max = 1000000, help = "of that tree"},
  {"exponent", 3.0, min = 1, max = 100, help = "of that tree: r^exponent adds up where vessels part"},
  {"orders", "diameter", choices = {"strahler", "diameter"}, help = "how vessels are ordered"},
  {"draw", "angles", choices = {"angles", "orders", "boxes"}, help = "what the picture shows"},
  {"size", 1000, min = 200, max = 8000, unit = "pixels", help = "width of the picture"},
}

local function grown()
  local tree = venule.cco {terminals = p.terminals, perfusion = 20000, exponent = p.exponent, seed = p.seed}
  tree:run {progress = true}
  return tree.network, tree.domain
end

local net, domain
if p.file == "" then
  net, domain = grown()
else
  net = venule.load(p.file)
  if type(net) == "table" then error(p.file .. " holds several networks; save one of them by itself") end
end

local m = net:measure_vessels {orders = p.orders}
local boxes = net:measure_boxes {}

-- ---- Lines ----

local function line(name, here, nature) print(("%-34s %-34s %s"):format(name, here, nature or "")) end

local function spread(s) return ("%.3g ± %.3g, median %.3g"):format(s.mean, s.deviation, s.median) end

line("", "here", "in nature")
line("Murray's law, missed by", ("%.2g at most, %.2g rms (exponent %g)"):format(m.murray.max, m.murray.rms, m.exponent))
line("exponent that keeps it", ("median %.3g, %.3g to %.3g"):format(m.fitted.median, m.fitted.lower, m.fitted.upper),
  "arteries 2.7 to 2.9, pig coronary 2.70 ± 0.20 (Marchesi 2026)")
line("daughters' radii, thin by thick", spread(m.ratio), "coronary casts: median 0.76 (Anat. Rec. 251, 1998)")
line("daughters' area by parent's", spread(m.expansion), "coronary casts: 0.93 ± 0.26 (Anat. Rec. 251, 1998)")
line("degrees between daughters", spread(m.angles.between), "retinal arteries: 78 (Luo 2017)")
line("fewer elements an order up", ("by %.3g (r² %.3g)"):format(m.bifurcation_ratio.ratio, m.bifurcation_ratio.r2))
line("thicker an order up", ("by %.3g (r² %.3g)"):format(m.diameter_ratio.ratio, m.diameter_ratio.r2),
  "pig coronary, orders 1 to 11: 1.82 (Kassab 1993)")
line("longer an order up", ("by %.3g (r² %.3g)"):format(m.length_ratio.ratio, m.length_ratio.r2),
  "pig coronary, orders 1 to 10: 1.82 (Kassab 1993)")
line("arc by chord, elements", spread(m.tortuosity.elements))
line("box dimension", ("%.3g (r² %.3g)"):format(boxes.dimension, boxes.r2),
  "conjunctiva 1.60 ± 0.07, by another protocol (methods differ by more)")
if domain then
  local tissue = net:measure_tissue {domain = domain}
  line("tissue to a vessel", ("%.3g in the mean, %.3g at most"):format(tissue.distance.mean, tissue.distance.max))
  line("tissue in vessels", ("%.3g %%"):format(100 * tissue.lumen))
end

-- ---- The picture ----

local function angles()
  local x, between, deviation, theory = {}, {}, {}, {}
  for _, bin in ipairs(m.angles.bins) do
    if bin.count > 0 then
      local i = #x + 1
      x[i], between[i], deviation[i], theory[i] = bin.ratio, bin.between.mean, bin.between.deviation, bin.theory.between
    end
  end
  return {label = "radius, thin daughter by thick", min = 0, max = 1}, {label = "degrees between daughters", min = 0}, {
    {x = x, y = between, deviation = deviation, marks = true, label = "this network"},
    {x = x, y = theory, marks = false, label = "Murray's"},
  }
end

-- Diameters of elements of the right coronary artery of pigs, µm (Kassab et al. 1993, as others quote them).
local KASSAB = {9.3, 12.8, 17.7, 28.6, 63.1, 132, 256, 428, 706, 1302, 3218}

local function orders()
  local x, y, pig, largest = {}, {}, {}, #m.orders
  for k, order in ipairs(m.orders) do x[k], y[k] = k - largest, order.elements.diameter.mean / m.orders[largest].elements.diameter.mean end
  local below = {}
  for k, diameter in ipairs(KASSAB) do below[k], pig[k] = k - #KASSAB, diameter / KASSAB[#KASSAB] end
  return {label = "order, from the highest down"}, {label = "diameter by that of the highest", log = true}, {
    {x = x, y = y, marks = true, label = "this network"},
    {x = below, y = pig, marks = true, label = "pig coronary (Kassab 1993)"},
  }
end

local function counts()
  local x, y, fit = {}, {}, {}
  local log_x, log_y = 0, 0
  for k, box in ipairs(boxes.boxes) do
    x[k], y[k] = box.side, box.count
    log_x, log_y = log_x + math.log(box.side) / #boxes.boxes, log_y + math.log(box.count) / #boxes.boxes
  end
  for k = 1, #x do fit[k] = math.exp(log_y - boxes.dimension * (math.log(x[k]) - log_x)) end
  return {label = "side of boxes", log = true}, {label = "boxes", log = true}, {
    {x = x, y = y, marks = true, line = false, label = "counted"},
    {x = x, y = fit, marks = false, label = ("dimension %.3f"):format(boxes.dimension)},
  }
end

local x, y, series = ({angles = angles, orders = orders, boxes = counts})[p.draw]()
venule.result {
  network = net,
  picture = venule.plot {width = p.size, height = p.size * 0.62, text_size = p.size / 60, x = x, y = y, series = series},
}
