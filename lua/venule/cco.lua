-- Arterial trees by constrained constructive optimisation (Kerautret et al. 2023): the engine's trees in a domain, with stages,
-- several trees by name, and results that say when the organ was full before the trees were whole.
local venule = ...

local options = require "venule.options"

local make_engine = venule.cco -- the engine's own constructor: what this file returns takes its name
local engine_rows, tree_rows = venule.cco_rows()

local own_rows = {
  {"perfusion", nil, type = "number", above = 0, unit = "mm² or mm³",
    doc = "area or volume of the domain where none is given: a disk or ball around the origin; left out: 20000"},
  {"square", nil, type = "boolean", doc = "a square or cube in its place"},
  {"dim", nil, type = "integer", min = 2, max = 3, doc = "its dimensions; left out: 2"},
  {"trees", nil, type = "table",
    doc = "several trees that keep clear of each other: a list of {name=, root=, …}; options of a tree that stand outside are for all of them"},
  {"avoid", nil, type = "any", doc = "a network to keep clear of, as tubes of its radii, or a list of them"},
  {"stages", nil, type = "table",
    doc = "growth in parts of the domain, one after the other: a list of {domain=, terminals=}; terminals that are left then fall anywhere"},
}

local function joined(...)
  local all = {}
  for _, rows in ipairs {...} do table.move(rows, 1, #rows, #all + 1, all) end
  return all
end

for _, row in ipairs(engine_rows) do
  if row[1] == "domain" then
    row.required, row.doc = false, "where everything is to lie; left out: by perfusion, square and dim"
  elseif row[1] == "terminals" then -- a number, whose range the engine checks, or a list
    row.type, row.min, row.max = "any", nil, nil
  end
end
for _, row in ipairs(tree_rows) do
  if row[1] == "root" then row.doc = row.doc .. "; left out: the point of the border nearest to the top of the domain's bounds" end
end

local cco_rows = joined(engine_rows, tree_rows, own_rows)
local branch_rows = joined({{"name", nil, type = "string", required = true, doc = "what it is called: s.name is its network"}}, tree_rows)
local stage_rows = {
  {"domain", nil, type = "userdata", doc = "the part that terminals fall into; left out: the whole domain"},
  {"terminals", nil, type = "integer", min = 1, unit = "terminals", required = true, doc = "how many more each tree is to have then"},
}

-- What was given of these rows; the engine has the defaults.
local function picked(rows, given, otherwise)
  local some = {}
  for _, row in ipairs(rows) do
    local name = row[1]
    some[name] = given[name]
    if some[name] == nil and otherwise then some[name] = otherwise[name] end
  end
  return some
end

local function default_domain(o)
  local measure, three = o.perfusion or 20000, o.dim == 3
  if not o.square then
    return three and venule.domain.sphere {radius = (measure * 3 / 4 / math.pi) ^ (1 / 3)}
      or venule.domain.disk {radius = math.sqrt(measure / math.pi)}
  end
  local half = measure ^ (1 / (o.dim or 2)) / 2
  return venule.domain.box {min = {-half, -half, three and -half or nil}, max = {half, half, three and half or nil}}
end

local function domain_of(o)
  if not o.domain then return default_domain(o) end
  for _, name in ipairs {"perfusion", "square", "dim"} do
    if o[name] ~= nil then error(("cco.%s: it describes a domain, and there is a domain= already; leave one of them out"):format(name), 3) end
  end
  return o.domain
end

-- Of the first tree without a root, the top; of others the bottom, the right, the left.
local sides = {{0.5, 1}, {0.5, 0}, {1, 0.5}, {0, 0.5}}

local function default_root(domain, number)
  local bounds, side = domain:bounds(), sides[(number - 1) % #sides + 1]
  local function at(k, share) return bounds.min[k] + (bounds.max[k] - bounds.min[k]) * share end
  if domain.dim == 2 then return {domain:closest(at(1, side[1]), at(2, side[2]))} end
  return {domain:closest(at(1, side[1]), at(2, side[2]), at(3, 0.5))}
end

local Cco, getters = {}, {}

local function check_name(name, taken)
  if taken[name] then error(('cco.trees: two trees are called "%s"'):format(name), 4) end
  if Cco[name] or getters[name] then error(('cco.trees: "%s" means something else already; call the tree otherwise'):format(name), 4) end
end

-- One tree, or the listed ones: {name, options}.
local function branches_of(o)
  if not o.trees then return {{name = o.venous and "veins" or "arteries", given = picked(tree_rows, o)}} end
  local branches, taken = {}, {}
  for i, given in ipairs(o.trees) do
    local read = options.read(("cco.trees[%d]"):format(i), branch_rows, given, 3)
    check_name(read.name, taken)
    taken[read.name] = true
    branches[i] = {name = read.name, given = picked(tree_rows, given, o)}
  end
  if #branches == 0 then error("cco.trees: a list of one or more trees {{name=, root=}, …} expected", 3) end
  return branches
end

local function check_stages(stages)
  local list, sum = {}, 0
  for i, given in ipairs(stages or {}) do
    list[i] = options.read(("cco.stages[%d]"):format(i), stage_rows, given, 3)
    sum = sum + list[i].terminals
  end
  return list, sum
end

local function each_report(self)
  local list = {}
  for i = 1, #self.names do list[i] = self.engine:report(i) end
  return list
end

-- The terminals that stages leave over fall anywhere, as a stage of their own.
local function add_last_stage(self, sum)
  if #self.stages == 0 then return end
  local most = 0
  for _, report in ipairs(each_report(self)) do most = math.max(most, report.terminals) end
  local left = self.goal - most - sum
  if left > 0 then self.stages[#self.stages + 1] = {terminals = left} end
  self.engine:stage(self.stages[1])
end

local function avoided(avoid)
  local list = type(avoid) == "table" and avoid or {avoid}
  for _, network in ipairs(list) do
    local class = type(network) == "userdata" and getmetatable(network).__name or type(network)
    if class ~= "venule.network" then error(("cco.avoid: a network or a list of them expected, got %s"):format(class), 3) end
  end
  return list
end

--- Arterial trees, ready to grow: s:step(), s:grow(n), s:run{}, s.network.
local function cco(given)
  local o = options.read("cco", cco_rows, given, 2)
  local domain = domain_of(o)
  local branches = branches_of(o)
  local stages, staged = check_stages(o.stages)
  local avoid = avoided(o.avoid)
  local wanted = picked(engine_rows, given)
  wanted.domain = domain
  if wanted.terminals == nil and staged > 0 then wanted.terminals = staged end
  local self = setmetatable({engine = make_engine(wanted), domain = domain, names = {}, stages = stages, stage = 1, starts = {}}, Cco)
  for _, network in ipairs(avoid) do self.engine:avoid(network) end
  for i, branch in ipairs(branches) do
    if not branch.given.from and not branch.given.root then branch.given.root = default_root(domain, i) end
    self.engine:add(branch.given)
    self.names[i] = branch.name
  end
  for i, report in ipairs(each_report(self)) do
    self.starts[i] = report.terminals
    self.goal = math.max(self.goal or 0, report.wanted)
  end
  add_last_stage(self, staged)
  return self
end

-- ---- What there is ----

local function network_at(self, i)
  self.cache = self.cache or {}
  self.cache[i] = self.cache[i] or self.engine:network(i)
  return self.cache[i]
end

local function by_name(self, value)
  local all = {}
  for i, name in ipairs(self.names) do all[name] = value(i) end
  return all
end

function getters.networks(self)
  return by_name(self, function(i) return network_at(self, i) end)
end

function getters.network(self)
  if #self.names > 1 then
    error(("cco: there are several trees: s.networks has them all, s.%s the first"):format(self.names[1]), 3)
  end
  return network_at(self, 1)
end

function getters.report(self)
  if #self.names == 1 then return self.engine:report(1) end
  return by_name(self, function(i) return self.engine:report(i) end)
end

function getters.volume(self)
  local sum = 0
  for _, report in ipairs(each_report(self)) do sum = sum + report.volume end
  return sum
end

function getters.done(self)
  return self.stage >= #self.stages and self.engine:done()
end

-- How much of it has grown, 0 to 1.
function getters.fraction(self)
  local has, wanted = 0, 0
  for i, report in ipairs(each_report(self)) do
    has, wanted = has + report.terminals - self.starts[i], wanted + math.max(self.goal - self.starts[i], 0)
  end
  return wanted > 0 and math.min(has / wanted, 1) or 1
end

local optional = {cache = true, goal = true, reason = true}

function Cco.__index(self, key)
  if Cco[key] then return Cco[key] end
  if getters[key] then
    local value = getters[key](self) -- no tail call: errors count the levels
    return value
  end
  if optional[key] then return nil end
  local names = {"step", "grow", "run", "engine", "domain"}
  for i, name in ipairs(self.names) do
    if name == key then return network_at(self, i) end
    names[#names + 1] = name
  end
  for name in pairs(getters) do names[#names + 1] = name end
  table.sort(names)
  error(('cco has no "%s"%s'):format(tostring(key), options.suggestion(tostring(key), names)), 2)
end

-- ---- Growth ----

-- Whether there is something to grow; a stage that is done gives way to the next.
local function open_stage(self)
  if not self.engine:done() then return true end
  if self.stage >= #self.stages then return false end
  self.stage = self.stage + 1
  self.engine:stage(self.stages[self.stage])
  return true
end

--- Add up to n terminals to each tree; how many came in all. Where there is no place for another: nil, why, how many came before.
function Cco:grow(n)
  local total, before = 0, each_report(self)
  if math.type(n) ~= "integer" or n < 1 then
    error(("cco:grow: a whole number of terminals, 1 or more, expected, got %s"):format(tostring(n)), 2)
  end
  local left = n
  while left > 0 and open_stage(self) do
    local added, why, some = self.engine:grow(left)
    self.cache = nil
    total = total + (added or some)
    if not added then return nil, why, total end
    left = n
    for i, report in ipairs(each_report(self)) do left = math.min(left, n - (report.terminals - before[i].terminals)) end
  end
  return total
end

--- Add a terminal to each tree; false when they have all they were to have, or no place is found: then the reason comes with it.
function Cco:step()
  local added, why = self:grow(1)
  if not added then return false, why end
  return not self.done
end

-- Nobody waits long for Ctrl-C or the progress line: a frame comes every two-hundredth, at least every 5,000 terminals.
local function frame_size(self)
  return math.max(1, math.min(self.goal // 200, 5000))
end

--- Grow to the end; the system, or false and why where the domain is full before. Then results that are written end the run
--- with exit status 3. A function given as `progress` is called at every frame.
function Cco:run(given)
  local o = options.read("run", {{"progress", nil, type = "any", doc = "true, or function(system) called at every frame"}}, given or {}, 2)
  local chunk = frame_size(self)
  while not self.done do
    local added, why = self:grow(chunk)
    if not added then
      local has = {}
      for i, report in ipairs(each_report(self)) do has[i] = ("%d of %d"):format(report.terminals, self.goal) end
      venule.note(why)
      venule.shortfall(("cco: only %s terminals found a place; what there is was written"):format(table.concat(has, " and ")))
      return false, why
    end
    if type(o.progress) == "function" then o.progress(self) end
    venule.frame(self.fraction)
  end
  return self
end

return {cco = cco, cco_rows = cco_rows, cco_branch_rows = branch_rows, cco_stage_rows = stage_rows}
