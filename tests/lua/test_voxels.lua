-- Networks in voxels as a script asks for them.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

local function read(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:read "a"
  file:close()
  os.remove(path)
  return bytes
end

-- A straight vessel of radius 1 along x, 10 long.
local function vessel(dim, unit, y)
  local net = venule.network {dim = dim, unit = unit, murray = {exponent = 3, tip_radius = 1}}
  net:add(net:root(0, y or 0, 0), 10, y or 0, 0)
  return net
end

function testAVolumeHasSizeTypeAndVoxels()
  local volume = vessel(3, "mm"):voxels {resolution = 0.5, content = "radius"}
  lu.assertEquals(volume.size, {26, 6, 6})
  lu.assertEquals({volume.resolution, volume.type, volume.unit}, {0.5, "f32", "mm"})
  lu.assertEquals(volume:at(13, 3, 3), 1.0)
  lu.assertEquals(volume:at(1, 1, 1), 0.0)
  lu.assertEquals({volume:position(1, 1, 1)}, {-1.25, -1.25, -1.25})
  local count = 0
  for i = 1, 26 do
    for j = 1, 6 do
      for k = 1, 6 do
        local x, y, z = volume:position(i, j, k)
        local along = x < 0 and x or x > 10 and x - 10 or 0
        local inside = along ^ 2 + y ^ 2 + z ^ 2 <= 1
        lu.assertEquals(volume:at(i, j, k) ~= 0, inside)
        count = count + (inside and 1 or 0)
      end
    end
  end
  lu.assertEquals(volume:count(), count)
end

function testSegmentsNameNodes()
  local net = vessel(3, "mm")
  local fork = net:add(2, 20, 0, 0)
  local left, right = net:add(fork, 30, 10, 0), net:add(fork, 30, -10, 0)
  local volume = net:voxels {resolution = 1, content = "segment"}
  local seen = {}
  for i = 1, volume.size[1] do
    for j = 1, volume.size[2] do
      for k = 1, volume.size[3] do seen[volume:at(i, j, k)] = true end
    end
  end
  lu.assertEquals(seen, {[0] = true, [fork] = true, [left] = true, [right] = true})
  lu.assertTrue(math.type(volume:at(1, 1, 1)) == "integer")
end

function testNetworksAreNumberedByNameOrInTheirOrder()
  local arteries, veins = vessel(3, "mm"), vessel(3, "mm", 5)
  local function labels(networks)
    local volume = venule.voxels {networks = networks, content = "label", resolution = 1}
    local _, y1 = volume:position(1, 3, 3)
    lu.assertEquals(y1, 0.5)
    return {volume:at(6, 3, 3), volume:at(6, 8, 3)}
  end
  lu.assertEquals(labels {veins = veins, arteries = arteries}, {1, 2})
  lu.assertEquals(labels {veins, arteries}, {2, 1})
  lu.assertEquals(venule.voxels {network = veins, resolution = 1, content = "label"}:count(),
                  veins:voxels {resolution = 1}:count())
end

function testFlatVolumes()
  local net = vessel(2, "um")
  local volume = net:voxels {size = 64, margin = 2, content = "vesselness"}
  lu.assertEquals({volume.size[1], volume.size[3], volume.unit}, {64, 1, "um"})
  lu.assertEquals(volume:at(32, 6), volume:at(32, 6, 1))
  lu.assertEquals(volume:at(32, 6), 1.0)
  local mask = net:voxels {resolution = 0.5, bounds = {min = {0, -1}, max = {10, 1}}}
  lu.assertEquals(mask.size, {20, 4, 1})
  mask:save "voxels.pgm"
  local bytes = read "voxels.pgm"
  lu.assertEquals(bytes:sub(1, 3), "P5\n")
  lu.assertEquals(bytes:sub(-80), ("\255"):rep(80))
end

function testFiles()
  local volume = vessel(3, "mm"):voxels {resolution = 0.5}
  volume:save "voxels.nii"
  local bytes = read "voxels.nii"
  local length = ("<I4"):unpack(bytes, 353)
  lu.assertEquals(#bytes, 352 + length + 26 * 6 * 6)
  lu.assertStrContains(bytes, '"venule": ')
  lu.assertEquals({("<i2i2i2i2"):unpack(bytes, 41)}, {3, 26, 6, 6, 49})
  volume:save "voxels.nii.gz"
  lu.assertEquals(read("voxels.nii.gz"):sub(1, 8), "\x1f\x8b\8\0\0\0\0\0")
  volume:save "voxels.nrrd"
  lu.assertStrContains(read "voxels.nrrd", "\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\n")
  volume:save "voxels.vol"
  lu.assertEquals(#read "voxels.vol":match "\n%.\n(.*)$", 26 * 6 * 6)
end

function testAVolumeCloses()
  local volume = vessel(3, "mm"):voxels {}
  volume:close()
  fails(function() volume:count() end, "this volume is closed")
end

function testMistakes()
  local net, bare = vessel(3, "mm"), venule.network {dim = 3}
  bare:add(bare:root(0, 0, 0), 1, 2, 3)
  local volume = net:voxels {resolution = 1}
  fails(function() net:voxels {resolutoin = 1} end, 'voxels: unknown field "resolutoin", did you mean "resolution"?')
  fails(function() net:voxels {resolution = 0} end, "voxels.resolution = 0 must be above 0 length: side of a voxel")
  fails(function() net:voxels {resolution = 1, size = 9} end, "voxels: give `resolution` or `size`, not both")
  fails(function() net:voxels {network = net} end,
        "voxels: `network` and `networks` are options of venule.voxels, not of net:voxels")
  fails(function() venule.voxels {} end, "voxels: give `network` or `networks`, one at least")
  fails(function() venule.voxels {networks = {net, 3}} end,
        "voxels.networks[2]: a network expected, and at most 256")
  fails(function() venule.voxels {networks = 3} end, "voxels.networks: a table of networks expected, got number")
  fails(function() bare:voxels {} end,
        'voxels: the network has no radii: call net:murray{…} first, or ask for content = "centerline"')
  fails(function() net:voxels {bounds = {min = {0, 0}, max = {1, 1}}} end,
        "voxels.bounds go from 0 to 0 in z: give finite numbers, min below max")
  fails(function() net:voxels {bounds = 3} end,
        "voxels.bounds: {min = {x, y}, max = {x, y}} expected, as domain:bounds() gives it, got number")
  fails(function() net:voxels(3) end, "voxels: a table of options {…} expected, got number")
  fails(function() volume:at(15, 1, 1) end, "volume i = 15 is not one of the 14 voxels from 1")
  fails(function() volume:at(1, 1) end, "volume k: number expected, got no value")
  fails(function() volume:save "voxels.png" end,
        "voxels.png: volumes are written as .nii, .nii.gz, .nrrd, .vol or, flat ones, .pgm; give such a name")
  fails(function() return volume.sizes end, 'volume has no "sizes", did you mean "size"?')
  lu.assertEquals(bare:voxels({content = "centerline", resolution = 1}):count(), 4)
end
