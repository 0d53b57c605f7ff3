-- Arterial trees as a script asks for them.
local venule = require "venule"
local lu = require "luaunit"

local domain = venule.domain

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

local function refuses(options, message)
  local ok, err = pcall(function() venule.cco(options):run() end)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
  lu.assertStrContains(err, "test_cco.lua:") -- the script's line, not one of ours
end

local function points_of(net)
  local list = {}
  for i = 1, #net do list[i] = {net.x[i], net.y[i], net.z[i], net.radius[i], net.flow[i], net.pressure[i], net.parent[i]} end
  return list
end

local function leaves(net)
  local list = {}
  for i = 1, #net do
    if #net:children(i) == 0 then list[#list + 1] = i end
  end
  return list
end

-- The physics of a whole tree, and that it is one: k terminals give 2k nodes.
local function check_tree(net, terminals, inflow)
  lu.assertEquals({#net, #leaves(net), #net:joins()}, {2 * terminals, terminals, 0})
  local report = net:flow {solve = false}
  lu.assertAlmostEquals(report.inflow, inflow, 1e-9 * inflow)
  lu.assertTrue(report.conservation.error < 1e-9 and report.drop.error < 1e-9 and report.terminal.error < 1e-6, tostring(report))
  lu.assertTrue(report.murray.max < 1e-9)
  lu.assertEquals(net.unit, "mm")
end

local LITRE_A_MINUTE = 1e6 / 60

function testTheGoldenTreeOfThreeTerminals()
  local tree = venule.cco {
    terminals = {{10, 2}, {4, -5}, {9, -3}}, domain = domain.disk {radius = 1000}, root = {0, 0}, growing_domain = false,
    inflow = 3 * 125 / 60,
  }
  lu.assertEquals({tree.fraction, tree.done, tree.report.wanted}, {0, false, 3})
  lu.assertIs(tree:run(), tree)
  lu.assertAlmostEquals(tree.volume, .415602, 5e-7)
  lu.assertAlmostEquals(tree.network:flow({solve = false}).volume, tree.volume, 1e-12)
  lu.assertEquals({tree.fraction, tree.done, tree.report.terminals}, {1, true, 3})
  check_tree(tree.network, 3, 3 * 125 / 60)
  local ends = {}
  for i, node in ipairs(leaves(tree.network)) do ends[i] = {tree.network.x[node], tree.network.y[node]} end
  lu.assertEquals(ends, {{10, 2}, {4, -5}, {9, -3}})
end

function testDefaultsAreThoseOfOpenCCO()
  local tree = venule.cco {terminals = 100}
  lu.assertAlmostEquals(tree.domain:measure(), 20000, 1e-6)
  lu.assertAlmostEquals(tree.domain:bounds().max[2], math.sqrt(20000 / math.pi), 1e-9)
  tree:run()
  check_tree(tree.network, 100, LITRE_A_MINUTE / 2)
  local net = tree.network
  lu.assertAlmostEquals(net.x[1], 0, 1e-9) -- the root is at the top
  lu.assertAlmostEquals(net.y[1], math.sqrt(20000 / math.pi), 1e-9)
  lu.assertAlmostEquals(net.pressure[1], 100 * 133.322, 1e-9)
  lu.assertIs(tree.arteries, net)
  lu.assertIs(tree.networks.arteries, net)
  lu.assertEquals(points_of(venule.cco({terminals = 100, domain = domain.disk {radius = math.sqrt(20000 / math.pi)},
    root = {0, math.sqrt(20000 / math.pi)}, seed = 1}):run().network), points_of(net))
  lu.assertNotEquals(venule.cco({terminals = 100, seed = 2}):run().volume, tree.volume)
end

function testDomainsOfAGivenMeasure()
  for _, case in ipairs {{dim = 2}, {dim = 3}, {square = true}, {square = true, dim = 3, perfusion = 1000}, {perfusion = 5}} do
    local options = {terminals = 30, dim = case.dim, square = case.square, perfusion = case.perfusion, inflow = 1}
    local tree = venule.cco(options):run()
    lu.assertAlmostEquals(tree.domain:measure(), case.perfusion or 20000, 1e-6)
    lu.assertEquals(tree.domain.dim, case.dim or 2)
    local corner = {}
    for k = 1, case.dim or 2 do corner[k] = 0.99 * tree.domain:bounds().max[k] end
    lu.assertEquals(tree.domain:contains(table.unpack(corner)), case.square or false)
    check_tree(tree.network, 30, 1)
    for i = 2, #tree.network do
      lu.assertTrue(tree.domain:contains(tree.network.x[i], tree.network.y[i], case.dim == 3 and tree.network.z[i] or nil))
    end
  end
end

function testStepsAndRunsGrowTheSameTree()
  local whole = venule.cco({terminals = 60}):run()
  local slow, steps = venule.cco {terminals = 60}, 1
  local first = slow.network
  lu.assertEquals(#first, 1)
  while slow:step() do steps = steps + 1 end
  lu.assertEquals({steps, slow:step(), #first}, {60, false, 1})
  lu.assertEquals(points_of(slow.network), points_of(whole.network))
  local parts = venule.cco {terminals = 60}
  lu.assertEquals({parts:grow(7), #parts.network, parts:grow(1000), parts:grow(1)}, {7, 14, 53, 0})
  lu.assertEquals(points_of(parts.network), points_of(whole.network))
  lu.assertIs(parts.network, parts.network)
  local seen = {}
  venule.cco({terminals = 4}):run {progress = function(tree) seen[#seen + 1] = tree.fraction end}
  lu.assertEquals(seen, {0.25, 0.5, 0.75, 1})
end

function testTwoTreesKeepClear()
  local organ = venule.cco {
    dim = 3, terminals = 80, inflow = 100,
    trees = {{name = "arteries"}, {name = "veins", venous = true, pressure_in = 2000, pressure_out = 1000}},
  }
  lu.assertIs(organ:run(), organ)
  lu.assertEquals({#organ.arteries, #organ.veins, organ.report.veins.terminals}, {160, 160, 80})
  lu.assertAlmostEquals(organ.volume, organ.report.arteries.volume + organ.report.veins.volume, 1e-9)
  check_tree(organ.arteries, 80, 100)
  lu.assertAlmostEquals(organ.veins.flow[1], -100, 1e-9) -- from child to parent
  lu.assertEquals({organ.arteries.y[1], organ.veins.y[1]}, {organ.domain:bounds().max[2], organ.domain:bounds().min[2]})
  -- Samples along every vein are outside of all arteries' capsules.
  local a, v = organ.arteries, organ.veins
  local function clear(x, y, z, r)
    for i = 2, #a do
      local j = a.parent[i]
      local dx, dy, dz = a.x[j] - a.x[i], a.y[j] - a.y[i], a.z[j] - a.z[i]
      local t = ((x - a.x[i]) * dx + (y - a.y[i]) * dy + (z - a.z[i]) * dz) / (dx * dx + dy * dy + dz * dz)
      t = math.max(0, math.min(1, t))
      local ex, ey, ez = a.x[i] + t * dx - x, a.y[i] + t * dy - y, a.z[i] + t * dz - z
      if math.sqrt(ex * ex + ey * ey + ez * ez) < (a.radius[i] + r) * (1 - 1e-9) then return false end
    end
    return true
  end
  for i = 2, #v do
    local j = v.parent[i]
    for k = 0, 4 do
      local t = k / 4
      lu.assertTrue(clear(v.x[i] + t * (v.x[j] - v.x[i]), v.y[i] + t * (v.y[j] - v.y[i]), v.z[i] + t * (v.z[j] - v.z[i]), v.radius[i]))
    end
  end
  fails(function() return organ.network end, "cco: there are several trees: s.networks has them all, s.arteries the first")
end

function testNetworksThatAreAvoided()
  local bar = venule.network {murray = {exponent = 3, tip_radius = 2}}
  bar:add(bar:root(20, -20), 60, -20)
  local tree = venule.cco({terminals = 60, avoid = bar, inflow = 100}):run()
  for i = 1, #tree.network do lu.assertTrue(math.abs(tree.network.y[i] + 20) > 2 or math.abs(tree.network.x[i] - 40) > 20) end
  local free = venule.cco({terminals = 60, inflow = 100}):run()
  lu.assertEquals(points_of(venule.cco({terminals = 60, avoid = {}, inflow = 100}):run().network), points_of(free.network))
  refuses({avoid = 3}, "cco.avoid: a network or a list of them expected, got number")
  refuses({dim = 3, avoid = {bar}}, "cco.avoid has 2 dimensions, and the domain 3")
end

function testGrowthGoesOnFromASavedTree()
  local path = os.tmpname() .. ".json"
  local first = venule.cco({terminals = 40}):run()
  first.network:save(path)
  local loaded = venule.load(path)
  os.remove(path)
  local tree = venule.cco {from = loaded, terminals = 100}
  lu.assertEquals({tree.report.terminals, tree.fraction}, {40, 0})
  tree:run()
  check_tree(tree.network, 100, LITRE_A_MINUTE / 2)
  for i = 1, #loaded do lu.assertEquals({tree.network.x[i], tree.network.y[i]}, {loaded.x[i], loaded.y[i]}) end
  local two = venule.network {}
  two:join(two:add(two:root(0, 0), 1, 0), two:add(1, 0, 1))
  refuses({from = two}, "cco.from has 1 joins: only a tree can be grown on")
end

function testStages()
  local left, right = domain.box {min = {-90, -90}, max = {0, 90}}, domain.box {min = {0, -90}, max = {90, 90}}
  local tree = venule.cco {terminals = 60, stages = {{domain = left, terminals = 20}, {domain = right, terminals = 30}}, inflow = 50}
  local function count(side, from)
    local n, list = 0, leaves(tree.network)
    for i = from, #list do n = n + (side:contains(tree.network.x[list[i]], tree.network.y[list[i]]) and 1 or 0) end
    return n
  end
  lu.assertEquals(tree:grow(20), 20)
  lu.assertEquals({count(left, 1), tree.done}, {20, false})
  lu.assertEquals(tree:grow(30), 30)
  lu.assertEquals({count(right, 1), tree.done, tree.fraction}, {30, false, 50 / 60})
  lu.assertEquals({tree:grow(50), tree.done}, {10, true}) -- the rest falls anywhere
  check_tree(tree.network, 60, 50)
  lu.assertEquals(venule.cco({stages = {{terminals = 3}, {domain = left, terminals = 4}}}).goal, 7)
  refuses({terminals = 10, stages = {{terminals = 11}}}, "cco.stage: 11 terminals more than the 0 there are, and cco.terminals = 10 in all")
  refuses({stages = {{terminals = 1, part = left}}}, 'cco.stages[1]: unknown field "part"')
end

function testDensities()
  local right = function(x) return x > 0 and 1 or 0 end
  local tree = venule.cco({terminals = 40, density = right, inflow = 50}):run()
  for _, node in ipairs(leaves(tree.network)) do lu.assertTrue(tree.network.x[node] > 0) end
  local box = domain.box {min = {-90, -90}, max = {0, 90}}
  tree = venule.cco({terminals = 40, density = box, inflow = 50}):run()
  for _, node in ipairs(leaves(tree.network)) do lu.assertTrue(tree.network.x[node] <= 0) end
end

function testFlowsThatVary()
  local tree = venule.cco({terminals = 30, inflow = 300, terminal_flow = function(x, y, z) return z == nil and (x > 0 and 2 or 1) end}):run()
  local net, sum = tree.network, 0
  for _, node in ipairs(leaves(net)) do
    lu.assertAlmostEquals(net.flow[node], net.x[node] > 0 and 20 or 10, 1e-9)
    sum = sum + net.flow[node]
  end
  lu.assertAlmostEquals(net.flow[1], sum, 1e-9)
  lu.assertAlmostEquals(venule.cco({terminals = 30, terminal_flow = 2}):run().network.flow[1], 60, 1e-9)
end

function testExponentsByFlow()
  local function volume(exponent) return venule.cco({terminals = 30, exponent = exponent}):run().volume end
  local three = volume(nil)
  lu.assertEquals(volume(3), three)
  lu.assertAlmostEquals(volume(function() return 3 end), three, 1e-9 * three)
  lu.assertAlmostEquals(volume {{1, 3}, {1000, 3}}, three, 1e-9 * three)
  lu.assertNotEquals(volume(2.5), three)
  -- A function and the list it is sampled into: linear in the flow's logarithm, it is the same between samples too.
  local q = LITRE_A_MINUTE / 2 / 30
  local by_function = volume(function(flow) return 2.5 + 0.5 * math.log(flow / q) / math.log(30) end)
  lu.assertAlmostEquals(by_function, volume {{q, 2.5}, {30 * q, 3}}, 1e-9 * by_function)
  lu.assertNotAlmostEquals(by_function, three, 1e-3 * three)
end

function testErrorsOfCallbacksTravelUnchanged()
  local reason = {}
  local ok, err = pcall(function() venule.cco({terminals = 5, density = function() error(reason) end}):run() end)
  lu.assertFalse(ok)
  lu.assertIs(err, reason)
  local tree = venule.cco {terminals = 5, terminal_flow = function() error("no flow", 0) end}
  ok, err = pcall(tree.run, tree)
  lu.assertEquals({ok, err}, {false, "no flow"})
  lu.assertFalse(pcall(tree.run, tree)) -- and it is open still
  -- What grows can neither be closed nor grown meanwhile.
  local told
  tree = venule.cco {terminals = 5, terminal_flow = function()
    told = {pcall(function() tree.engine:grow(1) end)}
    tree.engine:close()
    return 1
  end}
  lu.assertIs(tree:run(), tree)
  lu.assertFalse(told[1])
  check_tree(tree.network, 5, LITRE_A_MINUTE / 2)
  -- Nor can the tree it grows from be changed.
  local from = venule.cco({terminals = 3}):run().network
  tree = venule.cco {terminals = 5, from = from, terminal_flow = function() from:close() return 1 end}
  lu.assertEquals(#from, 6)
end

function testCoroutinesMayGrowIt()
  local tree = venule.cco {terminals = 5, density = function() return 1 end}
  local grow = coroutine.wrap(function() for _ = 1, 5 do coroutine.yield(tree:grow(1)) end end)
  for _ = 1, 5 do lu.assertEquals(grow(), 1) end
  lu.assertTrue(tree.done)
end

function testErrors()
  refuses({root = {500, 0}}, "cco.root at (500, 0, 0) is outside the domain")
  refuses({pressure_in = 60, pressure_out = 100}, "cco.pressure_in = 60 Pa must be above pressure_out = 100 Pa")
  refuses({terminals = 0}, "cco.terminals = 0 must be")
  refuses({terminals = {}}, "cco.terminals = 0 must be")
  refuses({terminals = 2.5}, "cco.terminals = 2.5 must be a whole number")
  refuses({terminals = "many"}, "cco.terminals: number expected, got string")
  refuses({terminals = {{0, 0}, {1}}}, "cco.terminals[2]: a point has 2 or 3 coordinates, not 1")
  refuses({terminals = {{500, 0}}}, "cco.terminals: number 1 at (500, 0, 0) is outside the domain")
  refuses({terminal = 3}, 'cco: unknown field "terminal", did you mean "terminals"?')
  refuses({inflow = 0}, "cco.inflow = 0 must be above 0 mm³/s")
  refuses({terminal_flow = 0}, "cco.terminal_flow = 0 mm³/s must be above 0")
  refuses({terminal_flow = function() return 0 end}, "would have the flow 0 mm³/s; it must be above 0")
  refuses({terminal_flow = function() end}, "cco.terminal_flow: the function has to return a number, got nil at (")
  refuses({terminal_flow = "x"}, "cco.terminal_flow: a number, a function or a domain expected, got string")
  refuses({density = 3}, "cco.density: a function or a domain expected, got number")
  refuses({density = function() return 2 end}, "cco.density is 2 at (")
  refuses({density = domain.sphere {}}, "cco.density has 3 dimensions, and the domain 2")
  refuses({exponent = 0.5}, "cco.exponent = 0.5 must be between 1 and 100")
  refuses({exponent = {}}, "cco.exponent: a list of 1 to 100,000 pairs {flow, exponent} expected, got 0")
  refuses({exponent = {{1, 3}, {1, 3}}}, "cco.exponent: the flow 1 mm³/s of a pair must be above the one before")
  refuses({exponent = {{1, 3, 4}}}, "cco.exponent[1]: a pair {flow, exponent} expected")
  refuses({exponent = function() return "3" end}, "cco.exponent, which the function returns: number expected, got string")
  refuses({exponent = true}, "cco.exponent: a number, a list {{flow, exponent}, …} or a function expected, got boolean")
  refuses({symmetry = 2}, "cco.symmetry = 2 must be from 0 to 1")
  refuses({bifurcation = "best"}, 'cco.bifurcation = "best" must be one of least, kamiya, ceres')
  refuses({domain = domain.disk {}, perfusion = 3}, "cco.perfusion: it describes a domain, and there is a domain= already")
  refuses({domain = venule.growth.none {domain = domain.disk {}}}, "cco.domain: a domain that stays expected, got a growth")
  refuses({trees = {}}, "cco.trees: a list of one or more trees")
  refuses({trees = {{root = {0, 0}}}}, "cco.trees[1]: `name` is missing")
  refuses({trees = {{name = "a", rot = {0, 0}}}}, 'cco.trees[1]: unknown field "rot", did you mean "root"?')
  refuses({trees = {{name = "a"}, {name = "a"}}}, 'cco.trees: two trees are called "a"')
  refuses({trees = {{name = "run"}}}, 'cco.trees: "run" means something else already')
  refuses({trees = {{name = "a"}, {name = "b", root = {0, 79}}}, root = {0, 79}}, "is in a vessel of another tree; move it")
  fails(function() return venule.cco({}).netwrok end, 'cco has no "netwrok", did you mean "network"?')
  fails(function() venule.cco({}):grow(0) end, "cco:grow: a whole number of terminals, 1 or more, expected, got 0")
  fails(function() venule.cco() end, "cco: a table of options {…} expected, got nil")
end

function testAMask()
  local path = os.tmpname() .. ".png"
  local shape = domain.disk {radius = 50} - domain.box {min = {-10, -60}, max = {10, 20}} -- a horseshoe
  local page = venule.canvas {width = 220, view = shape:bounds(), background = "black"}
  page:fill(shape, {color = "white"})
  page:save(path)
  local mask = domain.image(path, {pixel = 0.5})
  os.remove(path)
  local tree = venule.cco({domain = mask, terminals = 100, inflow = 50}):run()
  check_tree(tree.network, 100, 50)
  lu.assertAlmostEquals(tree.network.y[1], mask:bounds().max[2], 1) -- at the top, on the border
  local net = tree.network
  for i = 2, #net do
    local j = net.parent[i]
    for k = 0, 8 do
      local x, y = net.x[i] + k / 8 * (net.x[j] - net.x[i]), net.y[i] + k / 8 * (net.y[j] - net.y[i])
      lu.assertTrue(mask:distance(x, y) > -1e-6)
    end
  end
end

function testAMeshWithAHole()
  local box = {vertices = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 9}, {9, 0, 9}, {9, 9, 9}, {0, 9, 9}},
    faces = {{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}}}
  lu.assertErrorMsgContains("hole", function() venule.cco {domain = domain.mesh(box, {on = "inside"})} end)
  lu.assertErrorMsgContains("cco.domain is a surface, which has no inside: use on = \"inside\"", function()
    venule.cco {domain = domain.mesh(box)}
  end)
  box.faces[6] = {1, 4, 8, 5}
  check_tree(venule.cco({domain = domain.mesh(box, {on = "inside"}), terminals = 20, inflow = 0.01}):run().network, 20, 0.01)
end

function testAnOrganThatIsFull()
  local tree = venule.cco {terminals = 500, perfusion = 200, seed = 3}
  local ok, why = tree:run()
  lu.assertFalse(ok)
  lu.assertStrMatches(why, "cco: no place for terminal %d+ of 500 after 201 draws: .* larger domain%)")
  local refused, sum = tonumber(why:match "of (%d+) connections"), 0
  for count in why:match ": of %d+ connections refused so far (.*)":gmatch "%d+" do sum = sum + tonumber(count) end
  lu.assertTrue(refused > 0)
  lu.assertEquals(sum, refused)
  local has = tree.report.terminals
  lu.assertStrContains(why, ("terminal %d of 500"):format(has + 1))
  lu.assertTrue(has < 500 and not tree.done)
  lu.assertEquals(#tree.network, has > 0 and 2 * has or 1)
  venule.shortfall(nil)
end
