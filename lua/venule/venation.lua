-- Leaf venation, the loop of Runions et al. 2005, sections 3 and 4: the blade grows, sources appear, veins grow toward the
-- sources, sources that were reached go. Every primitive of it is public; copy the loop when an option is not enough.
local venule = ...

local options = require "venule.options"
local veinlets = require "venule.veinlet_phase"

local rows = {
  {"domain", nil, type = "userdata", required = true, doc = "a blade that grows (venule.growth), or a domain that stays"},
  {"rng", nil, type = "userdata", required = true, doc = "the random numbers: venule.rng(seed)"},
  {"roots", nil, type = "table", doc = "seed points {{x, y}, …}; left out: the lowest point of the blade"},
  {"network", nil, type = "userdata", doc = "a network to go on from, in place of roots"},
  {"birth_distance", nil, type = "number", above = 0, unit = "length", doc = "b_s: a new source keeps this far from other sources"},
  {"vein_distance", nil, type = "number", above = 0, unit = "length", doc = "b_v: and this far from veins; left out: birth_distance"},
  {"kill_distance", 1, type = "number", above = 0, unit = "length", doc = "d_k: a vein this close consumes its source"},
  {"segment_length", 1, type = "number", above = 0, unit = "length", doc = "D: the length a vein gains in a step"},
  {"attraction_distance", nil, type = "number", above = 0, unit = "length", doc = "sources farther than this draw no vein; left out: any distance"},
  {"darts", nil, type = "number", above = 0, unit = "darts/length²", required = true, doc = "ρ: darts thrown per area and step; under marginal growth, per area once"},
  {"neighborhood", "nearest", choices = {"nearest", "relative", "urquhart"}, doc = "which nodes a source draws: the nearest one (open venation), its relative neighbors (closed venation), or the Urquhart approximation of these"},
  {"vein_steps", nil, type = "integer", min = 1, max = 1000, doc = "vein steps to one growth step; left out: as many as keep pace with the tip"},
  {"stop", "reached", choices = {"reached", "grown"}, doc = "end when every source is reached, or as soon as the blade is grown"},
  {"veinlets", nil, type = "table", doc = "{birth_distance=, …}, as in venule.veinlets{…}: when all is done, veinlets that end freely"},
  {"murray", nil, type = "table", doc = "{exponent=, tip_radius=}: radii by Murray's law"},
  {"unit", nil, type = "string", doc = "length unit that files carry"},
}

local Venation = {}
Venation.__index = Venation

local function start_network(o, blade)
  if o.network then return o.network end
  local network = venule.network {dim = blade.dim, murray = o.murray, unit = o.unit}
  for _, p in ipairs(o.roots or {blade.origin}) do network:root(p[1], p[2], p[3]) end
  return network
end

local function as_growth(domain)
  return getmetatable(domain).__name == "venule.growth" and domain or venule.growth.none {domain = domain}
end

-- How many vein steps a growth step takes for veins to just keep pace with the tip (READINGS R7). A segment D is D/L of
-- the blade at length L, and all of them make up the whole: Σ D/L_t = 1. Where L grows by ΔL a step, that is D/ΔL · ln(L_f/L_i);
-- where it grows by a factor, D · (1/L_i − 1/L_f) · steps / ln(L_f/L_i).
local function keep_pace(blade, segment)
  local first, last, steps = blade.length, blade.final_length, blade.steps
  local n = 1
  if last > first and blade.kind == "isogonic" then
    n = (last - first) / steps / segment / math.log(last / first)
  elseif last > first and (blade.kind == "rerg" or blade.kind == "uniform") then
    n = math.log(last / first) / (steps * segment * (1 / first - 1 / last))
  end
  return math.tointeger(math.ceil(math.min(math.max(n, 1), 1000)))
end

--- Leaf venation, open or closed, ready to grow: s:step(), s:run{}, s.network, s.attractors.
local function venation(given)
  local o = options.read("venation", rows, given, 2)
  o.vein_distance = o.vein_distance or o.birth_distance
  o.veinlets = o.veinlets and options.read("venation.veinlets", veinlets.rows, o.veinlets, 2)
  local blade = as_growth(o.domain)
  o.vein_steps = o.vein_steps or keep_pace(blade, o.segment_length)
  if not o.birth_distance and blade.grown then
    error("venation: `birth_distance` is missing: on a blade that stays, sources would never cease to appear without it", 2)
  end
  return setmetatable({
    options = o,
    blade = blade,
    grows = not blade.grown,
    network = start_network(o, blade),
    attractors = venule.attractors {dim = blade.dim},
    idle = 0,
  }, Venation)
end

local function in_units(length, unit)
  return length and length * unit
end

function Venation:vein_step()
  local o, net, auxin, unit = self.options, self.network, self.attractors, self.blade.unit
  local closed = o.neighborhood ~= "nearest"
  local influence = auxin:influence(net, {mode = o.neighborhood, within = in_units(o.attraction_distance, unit)})
  local added = net:extend(influence, {length = o.segment_length * unit, domain = self.blade, meet = closed and "join" or "cross"})
  auxin:consume(net, {distance = o.kill_distance * unit, mode = closed and "tagged" or "any"})
  return added
end

-- Where darts go on for ever, the leaf is done after fifty steps without an accepted one; where less than one dart falls in a
-- step, after as many steps as fifty darts take.
local PATIENCE = 50

function Venation:is_done(growing, added, accepted)
  if growing then return false end
  if self.options.stop == "grown" then return true end
  self.idle = (added > 0 or accepted > 0) and 0 or self.idle + 1
  if self.grows then
    -- In open venation nothing grows any more once nothing has; in closed one, sources that block one another lose patience.
    local closed = self.options.neighborhood ~= "nearest"
    return #self.attractors == 0 or self.idle >= (closed and PATIENCE or 1)
  end
  local darts_a_step = self.options.darts / self.blade.unit ^ 2 * self.blade:measure()
  return self.idle >= PATIENCE * math.max(1, 1 / darts_a_step)
end

--- Grow by one step: blade, sources, then vein_steps times the veins. False when done.
function Venation:step()
  if self.done then return false end
  local o, net, auxin, blade = self.options, self.network, self.attractors, self.blade
  local growing, unit = blade:advance(net, auxin), blade.unit
  local accepted = (self.grows and not growing) and 0 or auxin:throw { -- new sources come with new tissue
    domain = blade, density = o.darts / unit ^ 2, spacing = in_units(o.birth_distance, unit),
    clearance = in_units(o.vein_distance, unit), network = net, rng = o.rng,
  }
  local added = 0
  for _ = 1, o.vein_steps do added = added + self:vein_step() end
  self.done = self:is_done(growing, added, accepted)
  if self.done and o.veinlets then self.veinlets = veinlets.grow(o.veinlets, self.blade.unit, self.network, self.blade, o.rng) end
  return not self.done
end

local function count(n, what)
  return ("%d %s%s"):format(n, what, n == 1 and "" or "s")
end

--- Say why sources were left or given up, if any were.
function Venation:report()
  venule.tell_stall()
  local retired = self.attractors.retired
  if retired.hidden > 0 then
    venule.note(count(retired.hidden, "source") .. " given up: no vein sees them without leaving the blade")
  end
  if retired.circled > 0 then
    local o = self.options
    venule.note(("%s given up: no vein came nearer to them, as %ssegment_length = %g is long for kill_distance = %g"):format(
      count(retired.circled, "source"), o.neighborhood ~= "nearest" and "others are in the way or " or "", o.segment_length, o.kill_distance))
  end
end

--- Grow to the end. Progress shows on a terminal; a function given as `progress` is called after every step.
function Venation:run(given)
  local o = options.read("run", {{"progress", nil, type = "any", doc = "true, or function(system) called after every step"}}, given or {}, 2)
  repeat
    local more = self:step()
    if type(o.progress) == "function" then o.progress(self) end
    venule.frame()
  until not more
  self:report()
  return self
end

return {venation = venation, venation_rows = rows}
