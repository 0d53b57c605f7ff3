-- Images and volumes as domains, as a script sees them.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
end

local function with_file(extension, content, body)
  local path = os.tmpname() .. extension
  local file = assert(io.open(path, "wb"))
  file:write(content)
  file:close()
  local ok, err = pcall(body, path)
  os.remove(path)
  if not ok then error(err, 0) end
end

-- The lower left pixel is dark, the upper right one half bright.
local picture = "P2 2 2 100\n 100 50\n 0 80\n"

function testAnImageIsADomain()
  with_file(".pgm", picture, function(path)
    local d = venule.domain.image(path, {pixel = 3})
    lu.assertEquals(d.dim, 2)
    lu.assertEquals(d:measure(), 27)
    lu.assertEquals(d:bounds().max, {6, 6})
    lu.assertTrue(d:contains(1, 5))
    lu.assertFalse(d:contains(1, 1))
    lu.assertEquals(d:distance(1.5, 4.5), 1.5)
    lu.assertAlmostEquals(d:distance(1, 2), -1, 1e-12)
    lu.assertAlmostEquals(select(2, d:closest(1, 2)), 3, 1e-12)
    lu.assertEquals(d:value(5, 5), 0.5)
    lu.assertEquals(d:value(1, 1), 0)
    lu.assertEquals(#d:sample(50, {rng = venule.rng(1)}), 50)
    lu.assertAlmostEquals((d - venule.domain.box {min = {3, 0}, max = {6, 6}}):measure(), 9, 1e-9)
    local c = venule.canvas {width = 60, view = d:bounds()}
    c:fill(d, {color = "#ff0000"})
    local dark = venule.domain.image(path, {threshold = 0.5, invert = true})
    lu.assertEquals(dark:measure(), 1)
    lu.assertEquals(dark:value(0.5, 0.5), 1)
    lu.assertEquals(venule.domain.image(path, {threshold = 0}):measure(), 4)
  end)
end

function testVeinsGrowInAnImage()
  with_file(".pgm", picture, function(path)
    local d = venule.domain.image(path, {pixel = 10})
    local leaf = venule.venation {
      domain = d, rng = venule.rng(2), roots = {{10.5, 5}}, darts = 20, birth_distance = 1, kill_distance = 0.5,
      segment_length = 0.4, attraction_distance = 9,
    }
    leaf:run()
    local net = leaf.network
    lu.assertTrue(#net > 50)
    for i = 1, #net do lu.assertTrue(d:contains(net.x[i], net.y[i])) end
  end)
end

function testTheLiverIsADomain()
  local d = venule.domain.volume "tests/files/volumes/liver.nii.gz"
  lu.assertEquals(d.dim, 3)
  lu.assertEquals(d.unit, "mm")
  lu.assertEquals(d:measure(), 218736 * 8)
  lu.assertEquals(d:bounds(), {min = {5, 5, 5}, max = {209, 177, 187}, unit = "mm"})
  lu.assertEquals(venule.domain.volume("tests/files/volumes/liver.nii.gz", {component = "all"}):measure(), 218737 * 8)
  for _, p in ipairs(d:sample(100, {rng = venule.rng(4)})) do
    lu.assertTrue(d:contains(p[1], p[2], p[3]))
    lu.assertEquals(d:value(p[1], p[2], p[3]), 1)
  end
end

function testAVolIsADomain()
  local header = "X: 2\nY: 1\nZ: 1\nVoxel-Size: 1\nAlpha-Color: 0\nVersion: 2\n.\n"
  with_file(".vol", header .. "\127\128", function(path)
    lu.assertEquals(venule.domain.volume(path):bounds().min, {0.5, -0.5, -0.5})
    lu.assertEquals(venule.domain.volume(path, {threshold = 1}):measure(), 2)
    fails(function() venule.domain.volume(path, {threshold = 129}) end, "the mask is empty: none of its 2 x 1 x 1 voxels is inside")
  end)
end

-- Rauch & Harders's regions of oxygen deficiency: a map says how many of the darts stay.
function testDartsAreWeighedByAMap()
  with_file(".pgm", picture, function(path)
    local map = venule.domain.image(path, {threshold = 0, pixel = 3})
    local box = venule.domain.box {min = {0, 0}, max = {6, 6}}
    local a, counts = venule.attractors {}, {}
    local stuck = a:throw {domain = box, count = 8000, weight = map, rng = venule.rng(2)}
    lu.assertEquals(stuck, #a)
    for i = 1, #a do
      local v = map:value(a.x[i], a.y[i])
      counts[v] = (counts[v] or 0) + 1
    end
    lu.assertNil(counts[0])
    for v, n in pairs(counts) do lu.assertAlmostEquals(n, 2000 * v, 150) end
    local same = venule.attractors {}
    same:throw {domain = box, count = 8000, weight = function(x, y) return map:value(x, y) end, rng = venule.rng(2)}
    lu.assertEquals(#same, #a)
    for i = 1, #a do lu.assertEquals(same.x[i], a.x[i]) end
  end)
end

function testDartsAreWeighedByAFunction()
  local ball, a = venule.domain.sphere {}, venule.attractors {dim = 3}
  a:throw {domain = ball, count = 2000, weight = function(_, _, z) return z > 0 and 1 or 0 end, rng = venule.rng(2)}
  lu.assertAlmostEquals(#a, 1000, 90)
  for i = 1, #a do lu.assertTrue(a.z[i] > 0) end
end

function testAWeightThatFailsIsNamed()
  local ball = venule.domain.sphere {}
  local function by(weight, a, network)
    a = a or venule.attractors {dim = 3}
    a:throw {domain = ball, count = 5, weight = weight, clearance = network and 0.1, network = network, rng = venule.rng(2)}
  end
  fails(function() by(0.5) end, "throw.weight: a function or a domain expected, got number")
  fails(function() by(function() end) end, "throw.weight: the function has to return a number, got nil at (")
  fails(function() by(function() return 2 end) end, "throw.weight is 2 at (")
  fails(function() by(function() return 0 / 0 end) end, "it must be between 0 and 1")
  fails(function() by(function() error "oh dear" end) end, "oh dear")
  fails(function() by(venule.domain.disk {}) end, "throw.weight has 2 dimensions, the attractors 3")
  local a, net = venule.attractors {dim = 3}, venule.network {dim = 3}
  fails(function() by(function() a:close() return a:add(0, 0, 0) end, a) end, "this attractors is closed")
  a:add(0, 0, 0) -- it was not: nobody closes what darts fall into
  lu.assertEquals(#a, 1)
  fails(function() by(function() net:close() return 1 end, a, net) end, "throw.weight: the function has closed the network")
  by(function() ball:close() collectgarbage() return 1 end, a)
  lu.assertEquals(#a, 6)
end

-- What is written as voxels is the same domain again, at the same place.
function testVoxelsOfANetworkComeBack()
  local net = venule.network {dim = 3, unit = "mm"}
  local root = net:root(1, 2, 3)
  net:add(net:add(root, 5, 2, 3), 5, 8, 4)
  net:murray {tip_radius = 0.6, exponent = 3}
  local volume = net:voxels {resolution = 0.25}
  local first
  for _, extension in ipairs {".nii", ".nii.gz", ".nrrd"} do
    local path = os.tmpname() .. extension
    volume:save(path)
    local d = venule.domain.volume(path, {component = "all"})
    os.remove(path)
    first = first or d:bounds()
    for k = 1, 3 do
      lu.assertAlmostEquals(d:bounds().min[k], first.min[k], 1e-6) -- NIfTI has floats
      lu.assertAlmostEquals(d:bounds().max[k], first.max[k], 1e-6)
    end
    lu.assertEquals(d.unit, "mm")
    for _, p in ipairs {{1, 2, 3}, {3, 2, 3}, {5, 5, 3.5}, {5, 8, 4}} do
      lu.assertTrue(d:contains(p[1], p[2], p[3]))
      lu.assertAlmostEquals(d:distance(p[1], p[2], p[3]), 0.6, 0.26)
    end
    lu.assertFalse(d:contains(1, 8, 4))
  end
end

function testWhatAScriptGetsWrongIsNamed()
  fails(function() venule.domain.image "no-such.png" end, "no-such.png: cannot be read")
  fails(function() venule.domain.image("no-such.png", {treshold = 1}) end, 'image: unknown field "treshold", did you mean "threshold"?')
  fails(function() venule.domain.image("no-such.png", {threshold = 2}) end, "image.threshold = 2 must be at most 1")
  fails(function() venule.domain.image("no-such.png", {pixel = 0}) end, "image.pixel = 0 must be above 0")
  fails(function() venule.domain.volume("no-such.nii", {component = "two"}) end, 'volume.component = "two" must be one of one|largest|all')
  fails(function() venule.domain.volume("no-such.obj") end, "a volume is read from")
  with_file(".pgm", "P2 3 1 1\n1 0 1\n", function(path)
    fails(function() venule.domain.image(path) end, "the mask has 2 parts that do not hang together, the largest of 1 and 1 voxels")
    lu.assertEquals(venule.domain.image(path, {component = "all"}):measure(), 2)
    lu.assertEquals(venule.domain.image(path, {component = "largest"}):bounds().max, {1, 1})
  end)
end
