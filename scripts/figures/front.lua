-- Of vessels on an organ, those that are seen: a canvas paints what is drawn last over all the rest. `front.width(net, organ,
-- eye)` is a width for canvas:stroke, which leaves out (with `hide_below`) what has the organ, a solid one, before it.
local front = {}

local function is_hidden(organ, at, eye, size)
  local d = {eye[1] - at[1], eye[2] - at[2], eye[3] - at[3]}
  local length = math.sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2)
  local t = 0.015 * size
  while t < math.min(size, length) do
    if organ:contains(at[1] + t / length * d[1], at[2] + t / length * d[2], at[3] + t / length * d[3]) then return true end
    t = t * 1.3
  end
  return false
end

function front.width(net, organ, eye, scale)
  local b, size = organ:bounds(), 0
  for k = 1, 3 do size = math.max(size, b.max[k] - b.min[k]) end
  return function(i)
    return is_hidden(organ, {net.x[i], net.y[i], net.z[i]}, eye, size) and 0 or 2 * (scale or 1) * net.radius[i]
  end
end

return front
