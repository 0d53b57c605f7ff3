-- Open leaf venation, the loop of Runions et al. 2005, section 3: the blade grows, sources appear, veins grow toward the
-- sources, sources that were reached go. Every primitive of it is public; copy the loop when an option is not enough.
local venule = ...

local options = require "venule.options"

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
  {"vein_steps", 1, type = "integer", min = 1, max = 1000, doc = "vein steps to one growth step"},
  {"stop", "reached", choices = {"reached", "grown"}, doc = "end when every source is reached, or as soon as the blade is grown"},
  {"murray", nil, type = "table", doc = "{exponent=, tip_radius=}: radii by Murray's law"},
  {"unit", nil, type = "string", doc = "length unit that files carry"},
}

local Venation = {}
Venation.__index = Venation

local function start_network(o, blade)
  if o.network then return o.network end
  local network = venule.network {murray = o.murray, unit = o.unit}
  for _, p in ipairs(o.roots or {blade.origin}) do network:root(p[1], p[2]) end
  return network
end

local function as_growth(domain)
  return getmetatable(domain).__name == "venule.growth" and domain or venule.growth.none {domain = domain}
end

--- Open venation, ready to grow: s:step(), s:run{}, s.network, s.attractors.
local function venation(given)
  local o = options.read("venation", rows, given, 2)
  o.vein_distance = o.vein_distance or o.birth_distance
  local blade = as_growth(o.domain)
  if not o.birth_distance and blade.length >= blade.final_length then
    error("venation: `birth_distance` is missing: on a blade that stays, sources would never cease to appear without it", 2)
  end
  return setmetatable({
    options = o,
    blade = blade,
    network = start_network(o, blade),
    attractors = venule.attractors {},
    idle = 0,
  }, Venation)
end

function Venation:vein_step()
  local o, net, auxin = self.options, self.network, self.attractors
  local closed = o.neighborhood ~= "nearest"
  local influence = auxin:influence(net, {mode = o.neighborhood, within = o.attraction_distance})
  local added = net:extend(influence, {length = o.segment_length, domain = self.blade, meet = closed and "join" or "cross"})
  auxin:consume(net, {distance = o.kill_distance, mode = closed and "tagged" or "any"})
  return added
end

-- Where darts go on for ever, the leaf is done after fifty steps without an accepted one; where less than one dart falls in a
-- step, after as many steps as fifty darts take.
local PATIENCE = 50

function Venation:is_done(growing, added, accepted)
  if growing then return false end
  if self.options.stop == "grown" then return true end
  self.idle = (added > 0 or accepted > 0) and 0 or self.idle + 1
  if self.blade.final_length > self.start_length then return #self.attractors == 0 or self.idle > 0 end
  local darts_a_step = self.options.darts * self.blade:measure()
  return self.idle >= PATIENCE * math.max(1, 1 / darts_a_step)
end

--- Grow by one step: blade, sources, then vein_steps times the veins. False when done.
function Venation:step()
  if self.done then return false end
  local o, net, auxin, blade = self.options, self.network, self.attractors, self.blade
  self.start_length = self.start_length or blade.length
  local growing = blade:advance(net, auxin)
  local accepted = auxin:throw {
    domain = blade, density = o.darts, spacing = o.birth_distance, clearance = o.vein_distance, network = net, rng = o.rng,
  }
  local added = 0
  for _ = 1, o.vein_steps do added = added + self:vein_step() end
  self.done = self:is_done(growing, added, accepted)
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
    venule.note(("%s given up: veins circle them, as segment_length = %g is too long for kill_distance = %g"):format(
      count(retired.circled, "source"), self.options.segment_length, self.options.kill_distance))
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
