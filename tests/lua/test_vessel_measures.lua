-- Measures of vessels, box counting and distances of tissue as a script asks for them.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

-- A trunk of 4 along x; at (4, 0) a right angle opens between two equal daughters, of which the lower forks again.
local function fork()
  local net = venule.network {murray = {exponent = 2.5, tip_radius = 0.1}, unit = "mm"}
  local at = net:add(net:root(0, 0), 4, 0)
  net:add(at, 6, 2)
  local low = net:add(at, 6, -2)
  net:add(low, 8, -2)
  net:add(low, 6, -4)
  return net
end

function testAForkByHand()
  local m = fork():measure_vessels()
  lu.assertEquals({m.exponent, m.bifurcations, m.furcations, m.segments, m.elements}, {2.5, 2, 0, 5, 4})
  lu.assertEquals(m.murray.count, 2)
  lu.assertTrue(m.murray.max < 1e-15 and m.murray.rms < 1e-15)
  lu.assertTrue(m.murray.worst == 2 or m.murray.worst == 4)
  lu.assertAlmostEquals(m.fitted.median, 2.5, 1e-12)
  lu.assertAlmostEquals(m.ratio.min, 2 ^ (-1 / 2.5), 1e-12)
  lu.assertEquals(m.ratio.max, 1)
  lu.assertAlmostEquals(m.expansion.max, 2 ^ (1 - 2 / 2.5), 1e-12)
  lu.assertAlmostEquals(m.angles.between.mean, 90, 1e-9)
  lu.assertAlmostEquals(m.angles.thick.mean, 45, 1e-9)
  lu.assertEquals(#m.angles.bins, 10)
  local bin = m.angles.bins[10]
  lu.assertEquals({bin.from, bin.to, bin.count, bin.ratio}, {0.9, 1, 1, 1})
  lu.assertAlmostEquals(bin.theory.between, 2 * math.deg(math.acos(2 ^ (2 / 2.5 - 1))), 1e-9)
  lu.assertNil(m.angles.bins[1].between)
  lu.assertEquals({#m.orders, m.orders[1].elements.count, m.orders[2].elements.count, m.orders[2].segments.count}, {2, 3, 1, 2})
  lu.assertAlmostEquals(m.orders[2].elements.length.mean, 4 + math.sqrt(8), 1e-12)
  lu.assertAlmostEquals(m.orders[1].segments.diameter.mean, 0.2, 1e-12)
  lu.assertAlmostEquals(m.bifurcation_ratio.ratio, 3, 1e-12)
  lu.assertAlmostEquals(m.tortuosity.elements.max, (4 + math.sqrt(8)) / math.sqrt(40), 1e-12)
  lu.assertEquals(m.curvature.segments.max, 0)
  lu.assertTrue(m.curvature.elements.max > 0)
end

function testOtherOrdersExponentsAndBins()
  local m = fork():measure_vessels {orders = "diameter", exponent = 3, bins = 2}
  lu.assertEquals({m.exponent, #m.angles.bins, m.angles.bins[2].count}, {3, 2, 2})
  lu.assertTrue(m.murray.min > 0.1)
  lu.assertEquals(#m.orders, 2)
end

function testBoxes()
  local net = venule.network {dim = 3}
  net:add(net:root(1, 1, 1), 1, 9, 1)
  local b = net:measure_boxes()
  lu.assertAlmostEquals(b.dimension, 1, 1e-12)
  lu.assertEquals({b.extent, #b.boxes, b.boxes[1].side, b.boxes[1].count, b.boxes[7].count}, {8, 7, 2, 4, 256})
  lu.assertEquals(#net:measure_boxes {coarsest = 1, finest = 3, offsets = 1}.boxes, 3)
end

function testTissueInEveryKindOfDomain()
  local flat = venule.network {}
  flat:root(0, 0)
  local t = flat:measure_tissue {domain = venule.domain.disk {radius = 3}, reach = 1.5}
  lu.assertAlmostEquals(t.distance.mean, 2, 1e-3)
  lu.assertAlmostEquals(t.perfused, 0.25, 1e-3)
  lu.assertEquals({#t.histogram, #t.furthest, t.lumen}, {20, 2, 0})
  lu.assertAlmostEquals(t.bin * 20, t.distance.max, 1e-12)
  lu.assertAlmostEquals(math.sqrt(t.furthest[1] ^ 2 + t.furthest[2] ^ 2), t.distance.max, 1e-12)
  lu.assertNil(flat:measure_tissue {domain = venule.domain.disk {}}.perfused)
  lu.assertTrue(flat:measure_tissue {domain = venule.growth.none {domain = venule.domain.disk {}}}.points > 39000)

  local solid = venule.network {dim = 3}
  solid:add(solid:root(0, 0, 0), 0, 0, 1)
  local ball = venule.domain.sphere {radius = 2}
  for _, domain in ipairs {ball, ball - venule.domain.sphere {radius = 1}, venule.domain.shell {domain = ball, thickness = 0.5}} do
    local in_space = solid:measure_tissue {domain = domain, resolution = 0.1, from = "centerline"}
    lu.assertAlmostEquals(in_space.points * 0.001 / domain:measure(), 1, 0.02)
    lu.assertEquals(#in_space.furthest, 3)
  end
  local mesh = {vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, faces = {{1, 3, 2}, {1, 2, 4}, {1, 4, 3}, {2, 3, 4}}}
  local inside = venule.domain.mesh(mesh, {on = "inside"})
  local surface = venule.domain.mesh(mesh)
  lu.assertAlmostEquals(solid:measure_tissue {domain = inside, resolution = 0.05}.points * 0.05 ^ 3, inside:measure(), 0.05)
  lu.assertAlmostEquals(solid:measure_tissue {domain = surface}.points, 40000, 1)

  local mask = venule.domain.volume("../files/volumes/liver.nii.gz", {threshold = 1})
  local low, high = mask:bounds().min, mask:bounds().max
  local chord = venule.network {dim = 3}
  chord:add(chord:root(low[1], low[2], low[3]), high[1], high[2], high[3])
  local in_mask = chord:measure_tissue {domain = mask, resolution = (high[1] - low[1]) / 50}
  lu.assertAlmostEquals(in_mask.points * in_mask.resolution ^ 3 / mask:measure(), 1, 0.02)
  lu.assertTrue(mask:contains(in_mask.furthest[1], in_mask.furthest[2], in_mask.furthest[3]))
end

function testWhatCannotBeMeasured()
  local net = venule.network {}
  local disk = venule.domain.disk {}
  fails(function() net:measure_boxes {} end, "measure_boxes: the network is empty; grow or load it first")
  net:root(0, 0)
  fails(function() net:measure_tissue {} end, "measure_tissue: `domain` is missing: the tissue: flat, solid or a surface")
  fails(function() net:measure_tissue {domain = disk, form = "surface"} end, 'measure_tissue: unknown field "form", did you mean "from"?')
  fails(function() net:measure_tissue {domain = venule.domain.sphere {}} end, "measure_tissue.domain is in 3D and the network in 2D; both must be of one dimension")
  fails(function() net:measure_vessels {orders = "horton"} end, 'measure_vessels.orders = "horton" must be one of strahler|diameter: by Strahler: tips 1, one more where two of the highest meet; by diameter: one more where a vessel is too thick for the order of its daughters (after Jiang, Kassab & Fung 1994)')
  fails(function() net:measure_vessels {orders = "diameter"} end, 'measure_vessels.orders = "diameter": the network has no radii; give it some by Murray\'s law (net:murray{…}), or ask for "strahler"')
  fails(function() net:measure_boxes {finest = 1} end, "measure_boxes.finest = 1 must be above coarsest = 2: a line needs two sizes")
end
