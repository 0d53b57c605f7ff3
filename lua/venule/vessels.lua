-- Blood vessels, the loop of Rauch & Harders 2021, section 3: oxygen drains appear, arteries grow toward them, drains that
-- were reached become sources of carbon dioxide, veins grow toward these, and the tissue grows. Every primitive of it is
-- public; copy the loop when an option is not enough.
local venule = ...

local options = require "venule.options"

-- Lengths that are left out are those of the authors' own program, for a disk of diameter 1, by the longest side of the domain.
local tree_rows = {
  {"perception_distance", nil, type = "number", above = 0, unit = "length", share = 0.065, doc = "δ: drains farther than this draw no vessel"},
  {"satisfaction", nil, type = "number", above = 0, unit = "length", share = 0.03, doc = "ε_k: a vessel this close satisfies a drain"},
  {"segment_length", nil, type = "number", above = 0, unit = "length", share = 0.03, doc = "d: the length a vessel gains in a step"},
  {"tip_radius", nil, type = "number", above = 0, unit = "length", share = 0.0005, doc = "r: radius of the last segments"},
  {"perception_angle", 90, above = 0, max = 360, unit = "degrees", doc = "γ: a leaf perceives what lies within half of it on either side of its direction, an inter-node around the optimal branch"},
  {"bias", 0.5, min = 0, max = 1, doc = "ω: how much of its own direction a vessel keeps, or of the optimal branch: 1 grows straight on"},
  {"bias_mean", true, doc = "weigh ω against the mean of the directions to drains, as the authors' program does; false: against their sum, as printed"},
  {"bifurcation_threshold", 15, above = 0, max = 180, unit = "degrees", doc = "φ: a leaf whose drains lie farther apart forks symmetrically"},
  {"bifurcate", true, doc = "whether leaves fork at all"},
  {"lateral", true, doc = "whether inter-nodes grow laterals"},
  {"murray_exponent", 2.55, above = 2, max = 4, doc = "κ: r^κ adds up where vessels part, and branching angles follow from it"},
}

local drain_rows = {
  {"darts", nil, type = "integer", min = 1, unit = "darts", doc = "thrown in each step (into a blade whose margin grows: in all); left out, with density: 1000"},
  {"density", nil, type = "number", above = 0, unit = "darts/length²", doc = "ρ: or darts per area (volume) of the grown tissue and step"},
  {"weight", nil, type = "any", doc = "a map (a domain with values) or function(x, y[, z]), 0 to 1: which part of the darts stays where they fall; regions that lack oxygen"},
  {"drain_spacing", nil, type = "number", above = 0, unit = "length", share = 0.03, doc = "ε_s: a new drain keeps this far from other drains"},
  {"drain_clearance", nil, type = "number", above = 0, unit = "length", share = 0.04, doc = "ε_n: and this far from arteries"},
}

local kind_rows = {
  {"roots", nil, type = "table", doc = "where trees begin: {{x, y}, …} or {{x, y, z}, …}, each with heading = {x, y} where its first segment has a direction"},
  {"network", nil, type = "userdata", doc = "a network to go on from, besides roots"},
  {"guides", nil, type = "any", doc = "paths that vessels follow first: {{{x, y}, …}, …}, or a network, or a file that has lines (venule.paths)"},
}

local own_rows = {
  {"domain", nil, type = "userdata", required = true, doc = "the tissue: a domain, or a growth"},
  {"rng", nil, type = "userdata", required = true, doc = "the random numbers: venule.rng(seed)"},
  {"arteries", nil, type = "table", required = true, doc = "{roots = {…}}, or guides =, or network =, with options that are to hold for arteries alone"},
  {"veins", nil, type = "table", doc = "likewise; left out: none grow"},
  {"steps", 100, type = "integer", min = 1, max = 1000000, doc = "how many; left out where there are stages or the domain grows by itself: theirs"},
  {"growth", 0.02, min = 0, max = 1, doc = "Δσ: what a step adds to the size of the tissue, by its size at first; 0: it stays"},
  {"stages", nil, type = "table", doc = "{{steps = 100, …}, …}: one after the other, each with options of its own"},
  {"avoid", false, doc = "arteries and veins keep clear of one another, as tubes of their radii"},
  {"unit", nil, type = "string", doc = "length unit that files carry"},
}

local function joined(...)
  local all = {}
  for _, rows in ipairs {...} do table.move(rows, 1, #rows, #all + 1, all) end
  return all
end

-- The same rows with nothing filled in: what is given there overrides what was given farther out.
local function bare(rows)
  local copies = {}
  for i, row in ipairs(rows) do
    local copy = {}
    for key, value in pairs(row) do copy[key] = value end
    copy.type, copy[2] = row.type or type(row[2]), nil
    copies[i] = copy
  end
  return copies
end

local vessels_rows = joined(own_rows, tree_rows, drain_rows)
local branch_rows = joined(kind_rows, bare(tree_rows))
local stage_rows = joined(
  {
    {"steps", nil, type = "integer", min = 1, max = 1000000, required = true, doc = "how many"},
    {"domain", nil, type = "userdata", doc = "where its drains fall and vessels grow, in the tissue's coordinates: a surface first, say, and then the inside; left out: the tissue"},
    {"arteries", nil, type = "table", doc = "options that are to hold for arteries alone"},
    {"veins", nil, type = "table", doc = "options that are to hold for veins alone"},
  }, bare(tree_rows), bare(drain_rows))

local Vessels = {}
Vessels.__index = Vessels

local function class_of(value)
  return type(value) == "userdata" and getmetatable(value).__name or type(value)
end

local function is_growth(value)
  return class_of(value) == "venule.growth"
end

-- The longest side; of a blade whose margin grows, when it is grown.
local function size_of(domain)
  local bounds, size = domain:bounds(), 0
  for k = 1, #bounds.min do size = math.max(size, bounds.max[k] - bounds.min[k]) end
  if is_growth(domain) and domain.kind == "marginal" then size = size * domain.final_length / domain.length end
  return size
end

-- The innermost of what was given, and else what the rows say.
local function settle(rows, size, ...)
  local read = {}
  for _, row in ipairs(rows) do
    local name, value = row[1], row[2]
    if row.share then value = row.share * size end
    for _, given in ipairs {...} do
      if given[name] ~= nil then value = given[name] end
    end
    read[name] = value
  end
  return read
end

-- Stages repeat what they do not change: each thing is said once.
local function teller()
  local told = {}
  return function(text)
    if not told[text] then venule.note(text) end
    told[text] = true
  end
end

local function check_distances(kind, r, spacing, note, level)
  if r.perception_distance <= r.satisfaction then
    error(("vessels.perception_distance = %g must be above satisfaction = %g (%s): drains that near are satisfied already, and nothing would grow"):format(
      r.perception_distance, r.satisfaction, kind), level)
  end
  if r.segment_length > 2 * r.satisfaction then
    note(("%s: segment_length = %g is more than twice satisfaction = %g: vessels overshoot their drains and run into others"):format(
      kind, r.segment_length, r.satisfaction))
  end
  if r.perception_angle > 180 then
    note(("%s: perception_angle = %g is above 180: vessels turn back on themselves"):format(kind, r.perception_angle))
  end
  if r.bias > 0.9 then
    note(("%s: bias = %g is above 0.9: vessels run straight past their drains"):format(kind, r.bias))
  end
  if spacing and spacing > 1.5 * r.perception_distance then
    note(("drain_spacing = %g is more than perception_distance = %g reaches: vessels lose sight of the next drain"):format(
      spacing, r.perception_distance))
  end
end

-- What holds in each stage for each kind of tree: what is said of a kind outweighs what is said of all, and what a stage says of
-- either outweighs what holds in all stages.
local function plan(o, given, branches, size, level)
  local stages, note = {}, teller()
  if o.stages and #o.stages == 0 then error("vessels.stages: a list {{steps = 100, …}, …} of one or more expected", level) end
  for i, stage in ipairs(o.stages or {{steps = o.steps}}) do
    local name = o.stages and ("vessels.stages[%d]"):format(i) or "vessels"
    local own = o.stages and options.read(name, stage_rows, stage, level) or stage
    local drains = settle(drain_rows, size, given, own)
    if own.darts then drains.density = nil elseif own.density then drains.darts = nil end
    local one = {steps = own.steps, domain = own.domain, drains = drains}
    for _, kind in ipairs {"arteries", "veins"} do
      local inner = own[kind] and options.read(name .. "." .. kind, bare(tree_rows), own[kind], level) or {}
      one[kind] = settle(tree_rows, size, given, own, branches[kind] or {}, inner)
      if o[kind] then check_distances(kind, one[kind], kind == "arteries" and drains.drain_spacing, note, level + 1) end
    end
    if not drains.darts and not drains.density then drains.darts = 1000 end
    if drains.darts and drains.density or own.darts and own.density then error(name .. ": give either `darts` or `density`", level) end
    stages[i] = one
  end
  return stages
end

-- Vessels along the paths that the user gives; what grows by itself goes on from them (Figure 4).
local function lay_guides(kind, network, guides, first, place, level)
  local paths, name = guides, ("vessels.%s.guides"):format(kind)
  local is_file = type(guides) == "string" or type(guides) == "userdata"
  if not is_file and type(guides) ~= "table" then
    error(("%s: paths {{{x, y}, …}, …}, a network or the name of a file expected, got %s"):format(name, type(guides)), level + 1)
  end
  if is_file then paths = venule.paths(guides) end
  network:follow(paths, {length = first.segment_length, within = first.perception_distance, domain = place, name = name})
end

local function check_point(p, dim, what, level)
  if type(p) ~= "table" or #p ~= dim then error(("%s: {x, y%s} expected"):format(what, dim == 3 and ", z" or ""), level + 1) end
end

local function start_network(kind, read, o, first, place, level)
  local dim = place.dim
  local network = read.network or venule.network {dim = dim, unit = o.unit}
  if class_of(network) ~= "venule.network" or network.dim ~= dim then
    error(("vessels.%s.network: a network of %d dimensions expected, as the domain has"):format(kind, dim), level)
  end
  network:murray {exponent = first.murray_exponent, tip_radius = first.tip_radius}
  for i, p in ipairs(read.roots or {}) do
    local what = ("vessels.%s.roots[%d]"):format(kind, i)
    check_point(p, dim, what, level)
    local root = network:root(table.unpack(p, 1, dim))
    if p.heading then
      check_point(p.heading, dim, what .. ".heading", level)
      network:heading(root, table.unpack(p.heading, 1, dim))
    end
  end
  if read.guides ~= nil then lay_guides(kind, network, read.guides, first, place, level) end
  if #network == 0 then error(("vessels.%s: give roots = {{x, y}, …}, guides, or a network to go on from"):format(kind), level) end
  return network
end

local function total_steps(stages)
  local steps = 0
  for _, stage in ipairs(stages) do steps = steps + stage.steps end
  return steps
end

--- Arteries and veins that grow together, ready to grow: s:step(), s:run{}, s.arteries, s.veins.
local function vessels(given)
  local o, branches = options.read("vessels", vessels_rows, given, 2), {}
  if class_of(o.domain) ~= "venule.domain" and not is_growth(o.domain) then
    error(("vessels.domain: a domain or a growth expected, got %s"):format(tostring(o.domain)), 2)
  end
  for _, kind in ipairs {"arteries", "veins"} do
    branches[kind] = o[kind] and options.read("vessels." .. kind, branch_rows, o[kind], 2)
  end
  if o.veins and branches.veins.network and branches.veins.network == branches.arteries.network then
    error("vessels.veins.network: it is the arteries' already", 2)
  end
  if is_growth(o.domain) and not given.steps and not o.stages then o.steps = math.max(1, o.domain.steps) end
  local stages = plan(o, given, branches, size_of(o.domain), 3)
  local dim = o.domain.dim
  local s = {
    options = o, stages = stages, stage = 1, stage_step = 0, steps = total_steps(stages), time = 0, tissue = o.domain, networks = {},
    begun = {}, drains = venule.attractors {dim = dim}, sources = venule.attractors {dim = dim},
    unit = is_growth(o.domain) and o.domain.unit or 1,
  }
  for _, kind in ipairs {"arteries", "veins"} do
    if o[kind] then
      s[kind] = start_network(kind, branches[kind], o, stages[1][kind], stages[1].domain or s.tissue, 3)
      s.networks[kind], s.begun[kind] = s[kind], #s[kind]
    end
  end
  return setmetatable(s, Vessels)
end

-- Today's tissue, or the part of it that the stage is about: in relative coordinates that keeps its place too.
function Vessels:place()
  return self.stages[self.stage].domain or self.tissue
end

function Vessels:throw(r)
  local unit, place = self.unit, self:place()
  return self.drains:throw {
    domain = place, count = r.darts, density = r.density and r.density / unit ^ place.measure_dim, spacing = r.drain_spacing * unit,
    clearance = r.drain_clearance * unit, network = self.arteries, weight = r.weight, rng = self.options.rng,
  }
end

--- Let one kind of tree grow by one step; how many nodes it gained.
function Vessels:grow(kind, attractors, other, into)
  local r, network, unit = self.stages[self.stage][kind], self[kind], self.unit
  network:murray {exponent = r.murray_exponent, tip_radius = r.tip_radius * unit}
  local influence = attractors:influence(network, {
    within = r.perception_distance * unit, perception = {angle = r.perception_angle, lateral = r.lateral},
  })
  local added = network:extend(influence, {
    length = r.segment_length * unit, domain = self:place(), bias = r.bias, bias_mean = r.bias_mean,
    bifurcate = r.bifurcate and r.bifurcation_threshold or nil, avoid = self.options.avoid and other or nil,
  })
  attractors:consume(network, {distance = r.satisfaction * unit, into = into})
  return added
end

function Vessels:next_stage()
  self.time, self.stage_step = self.time + 1, self.stage_step + 1
  if self.stage_step >= self.stages[self.stage].steps and self.stage < #self.stages then
    self.stage, self.stage_step = self.stage + 1, 0
  end
end

-- In relative coordinates: the tissue keeps its place and its lengths shrink, λ_t = λ_0 σ_0 / σ_t. A growth that was given moves,
-- or shrinks its unit, as it will; when it is grown the tissue stays.
function Vessels:grow_tissue()
  local tissue = self.tissue
  if not is_growth(tissue) then
    self.unit = 1 / (1 + self.options.growth * self.time)
  elseif self.veins then
    tissue:advance(self.arteries, self.veins, self.drains, self.sources)
  else
    tissue:advance(self.arteries, self.drains)
  end
  if is_growth(tissue) then self.unit = tissue.unit end
end

--- Grow by one step: drains, arteries, veins, tissue (READINGS R20). False when done.
function Vessels:step()
  if self.time >= self.steps then return false end
  self:throw(self.stages[self.stage].drains)
  self:grow("arteries", self.drains, self.veins, self.veins and self.sources)
  if self.veins then self:grow("veins", self.sources, self.arteries) end
  self:next_stage()
  if self.time >= self.steps then return false end
  self:grow_tissue()
  return true
end

--- Say what was given up, and what never began.
function Vessels:report()
  for _, kind in ipairs {"arteries", "veins"} do
    local network, attractors = self[kind], kind == "arteries" and self.drains or self.sources
    if network and #network == self.begun[kind] then
      venule.note(("%s never grew: no %s came within perception_distance = %g of a root; raise it, or place roots nearer"):format(kind,
        kind == "arteries" and "drain" or "satisfied drain", self.stages[1][kind].perception_distance))
    end
    if network and attractors.retired.barred > 0 then
      venule.note(("%s: %d drains given up, as their vessels would have met others"):format(kind, attractors.retired.barred))
    end
  end
end

--- Grow to the end. Progress shows on a terminal; a function given as `progress` is called after every step.
function Vessels:run(given)
  local o = options.read("run", {{"progress", nil, type = "any", doc = "true, or function(system) called after every step"}}, given or {}, 2)
  repeat
    local more = self:step()
    if type(o.progress) == "function" then o.progress(self) end
    venule.frame(self.time / self.steps)
  until not more
  self:report()
  return self
end

return {vessels = vessels, vessels_rows = vessels_rows, vessels_branch_rows = branch_rows, vessels_stage_rows = stage_rows}
