-- Brochidodromous venation, which Runions et al. 2005 leave open (section 7): secondary veins that do not reach the margin, but
-- curve up and join the next one above in regular, pronounced arches (Eucalyptus, Ficus). Sources appear along a margin that
-- moves outward, one to a secondary, as in a blade that widens; then up along the margin; the last ones lie between the end of
-- an arch and the next secondary, draw both, and join them. What is left is for venule.venation{network=}.
local venule = ...

local options = require "venule.options"

local rows = {
  {"domain", nil, type = "userdata", required = true, doc = "the blade: its petiole at `root`, its tip above that"},
  {"rng", nil, type = "userdata", required = true, doc = "the random numbers: venule.rng(seed)"},
  {"root", {0, 0}, type = "table", doc = "where the midvein starts: {x, y}"},
  {"secondaries", 12, type = "integer", min = 2, max = 200, doc = "at each side"},
  {"rise", 0.1, type = "number", min = 0, max = 0.6, doc = "how far the longest ones climb toward the tip, of the blade's length"},
  {"reach", 0.8, type = "number", min = 0.2, max = 0.95, doc = "how near the margin arches come, of the way from the midvein"},
  {"irregularity", 0.1, type = "number", min = 0, max = 0.3, doc = "of the places of secondaries, in shares of the gap between them"},
  {"segment_length", 1, type = "number", above = 0, unit = "length", doc = "D: the length a vein gains in a step"},
}

local FIRST, LAST = 0.07, 0.86 -- secondaries leave the midvein within this part of it
local BEND = 0.18 -- how far an arch turns back from the margin
local LED, CLOSED = 7, 0.85 -- tenths of an arch that are led by a source each, and where the one is that closes it
local PATIENCE = 10 -- steps in which a source may wait for a vein that does not come

local Arches = {}
Arches.__index = Arches

-- How far the blade reaches from its midvein at height y.
function Arches:width(side, y)
  local blade, x = self.options.domain, self.x
  local low, high = 0, self.widest
  if not blade:contains(x, y) then return 0 end
  for _ = 1, 40 do
    local middle = (low + high) / 2
    if blade:contains(x + side * middle, y) then low = middle else high = middle end
  end
  return low
end

function Arches:place(side, share, y)
  return self.x + side * share * self:width(side, y), y
end

-- Veins grow until every source is reached.
function Arches:reach(auxin, mode)
  local o, net = self.options, self.network
  local closed, idle = mode == "relative", 0
  repeat
    local added = net:extend(auxin:influence(net, {mode = mode}),
      {length = o.segment_length, domain = o.domain, meet = closed and "join" or "stop"})
    local consumed = auxin:consume(net, {distance = o.segment_length, mode = closed and "tagged" or "any"})
    idle = added + consumed > 0 and 0 or idle + 1
    venule.frame()
  until #auxin == 0 or idle > PATIENCE
end

--- Let every secondary, or every one but the highest, be drawn to a source at `where(vein)`.
function Arches:draw(where, mode)
  local auxin = venule.attractors {}
  for _, vein in ipairs(self.secondaries) do
    local x, y = where(vein)
    if x and self.options.domain:contains(x, y) then auxin:add(x, y) end
  end
  self:reach(auxin, mode or "nearest")
end

function Arches:grow_midvein()
  local top = venule.attractors {}
  top:add(self.x, self.y + 0.97 * self.length)
  self:reach(top, "nearest")
end

-- From the base to the tip, in turn at either side.
function Arches:place_secondaries()
  local o = self.options
  self.gap = (LAST - FIRST) * self.length / (o.secondaries - 0.5)
  for k = 1, 2 * o.secondaries do
    local y = self.y + FIRST * self.length + (k - 1) / 2 * self.gap + o.irregularity * self.gap * o.rng:uniform(-1, 1)
    local side = k % 2 == 1 and 1 or -1
    self.secondaries[k] = {side = side, foot = y, above = k + 2}
    self.broadest = math.max(self.broadest, self:width(side, y))
  end
end

-- Where a secondary is at a share of its way out: straight at first, then turning up.
function Arches:course(vein, share)
  local climb = self.options.rise * self.length * self:width(vein.side, vein.foot) / self.broadest
  return vein.foot + climb * (0.6 * share + 0.4 * share ^ 4)
end

function Arches:grow_secondaries()
  local rounds = math.ceil(5 * self.broadest / self.gap)
  for r = 1, rounds do
    self:draw(function(vein) return self:place(vein.side, self.options.reach * r / rounds, self:course(vein, r / rounds)) end)
  end
end

-- The arch from one secondary to the next, at a share of the way up.
function Arches:arch(vein, share)
  local next_one = self.secondaries[vein.above]
  if not next_one then return nil end
  local from, to = self:course(vein, 1), self:course(next_one, 1 - BEND)
  return self:place(vein.side, self.options.reach * (1 - BEND * share ^ 2), from + share * (to - from))
end

function Arches:grow_arches()
  for tenth = 1, LED do
    self:draw(function(vein) return self:arch(vein, tenth / 10) end)
  end
  self:draw(function(vein) return self:arch(vein, CLOSED) end, "relative")
  self.arches = #self.network:joins()
  local most = 2 * self.options.secondaries - 2
  if self.arches < most then
    venule.note(("brochidodromous: %d of %d pairs of secondaries are joined: too many for segments as long as these"):format(self.arches, most))
  end
end

--- A midvein, and secondaries that are joined in `arches`: `network`, to go on from.
local function brochidodromous(given)
  local o = options.read("brochidodromous", rows, given, 2)
  local box = o.domain:bounds()
  local self = setmetatable({
    options = o,
    network = venule.network {},
    x = o.root[1],
    y = o.root[2],
    length = box.max[2] - o.root[2],
    widest = box.max[1] - box.min[1],
    broadest = 0,
    secondaries = {},
  }, Arches)
  self.network:root(self.x, self.y)
  self:grow_midvein()
  self:place_secondaries()
  self:grow_secondaries()
  self:grow_arches()
  return self
end

return {brochidodromous = brochidodromous, brochidodromous_rows = rows}
