#!/bin/sh
# The program from outside: run.sh PATH_TO_VENULE SOURCE_DIR. One line a check; fails when one fails.
set -u
LC_ALL=C
export LC_ALL
if [ $# -ne 2 ]; then
  echo "usage: run.sh PATH_TO_VENULE SOURCE_DIR" >&2
  exit 2
fi
program=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
source=$(cd "$2" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
to=$work/to
mkdir "$work/in" "$work/folder.svg" "$to"
cd "$work/in" || exit 1
pty=$(command -v script || true) # makes a terminal; before a function below takes its name
checks=0
failures=0

ok() {
  checks=$((checks + 1))
  echo "ok   $1"
}

bad() {
  checks=$((checks + 1))
  failures=$((failures + 1))
  echo "FAIL $1: $2"
}

skip() { echo "skip $1: $2"; }

script() { cat >"$1.lua"; }

left() { ls -A "$to"; }

# expect NAME STATUS TEXT COMMAND...: the exit status, TEXT on stderr (and nothing but that line), no file after a failure.
expect() {
  name=$1 want=$2 text=$3
  shift 3
  "$@" >"$work/out" 2>"$work/err" </dev/null
  got=$?
  if [ "$got" -ne "$want" ]; then
    bad "$name" "exit status $got, not $want: $(head -c 300 "$work/err")"
  elif [ -n "$text" ] && ! grep -qF -e "$text" "$work/err"; then
    bad "$name" "stderr has no \"$text\": $(head -c 400 "$work/err")"
  elif [ "$want" -ne 0 ] && [ "$(wc -l <"$work/err")" -ne 1 ]; then
    bad "$name" "not one line: $(head -c 400 "$work/err")"
  elif [ "$want" -ne 0 ] && [ -n "$(left)" ]; then
    bad "$name" "left behind: $(left | tr '\n' ' ')"
  else
    ok "$name"
  fi
  if [ "$want" -ne 0 ]; then rm -rf "$to"; mkdir "$to"; fi
}

says() { # NAME TEXT: the last command's stdout has TEXT
  if grep -qF -e "$2" "$work/out"; then ok "$1"; else bad "$1" "stdout has no \"$2\": $(head -c 300 "$work/out")"; fi
}

same() { # NAME FILE OTHER
  if cmp -s "$2" "$3"; then ok "$1"; else bad "$1" "$2 and $3 differ"; fi
}

holds() { # NAME FILE TEXT
  if grep -qaF -e "$3" "$2"; then ok "$1"; else bad "$1" "$2 has no \"$3\""; fi
}

begins() { # NAME FILE BYTES
  if [ "$(head -c "$(printf %s "$3" | wc -c)" "$2" 2>/dev/null | tr -d '\0')" = "$3" ]; then ok "$1"; else bad "$1" "$2 does not begin with $3"; fi
}

empty() { # NAME FILE
  if [ -s "$2" ]; then bad "$1" "$(head -c 300 "$2")"; else ok "$1"; fi
}

# ---------------------------------------------------------------- a small leaf

script leaf <<'EOF'
local venule = require "venule"
local p = venule.param {
  {"kill_distance", 2, min = 0.5, max = 40, unit = "mm", help = "a vein this close consumes a source"},
  {"name", "leaf", choices = {"leaf", "lung"}, help = "what it is called"},
  {"open", true, help = "whether"},
  {"steps", 10, min = 1, max = 100},
}
local shape = venule.domain.polygon {{0, 0}, {30, 20}, {22, 45}, {0, 80}, {-22, 45}, {-30, 20}}
local leaf = venule.venation {
  domain = venule.growth.marginal {domain = shape, from = 10, step = 5}, rng = venule.rng(p.seed), darts = 0.1,
  birth_distance = 3, kill_distance = p.kill_distance, murray = {exponent = 2, tip_radius = 0.1}, unit = "mm",
}
leaf:run()
leaf.network:orders "hickey"
venule.result {
  network = leaf.network, width = 300, view = shape:bounds(), background = "white", unit = "mm",
  picture = function(page)
    page:fill(shape, {color = "#dbe8c4"})
    page:stroke(leaf.network, {color = "#3d5c2b"})
  end,
}
EOF

# Valid JSON, by a reader of our own: the machine may have none.
script json <<'EOF'
local venule = require "venule"
local p = venule.param {{"file", "x", file = true}}
local text = assert(io.open(p.file, "rb")):read "a"
local at, value = 1, nil
local function skip() at = text:find("[^ \t\r\n]", at) or #text + 1 end
local function take(pattern)
  local from, to = text:find("^" .. pattern, at)
  if not from then error(("no JSON at byte %d: %s"):format(at, text:sub(at, at + 20)), 0) end
  at = to + 1
  skip()
end
local function word()
  at = at + 1
  while text:sub(at, at) ~= '"' do
    if text:find("^\\u%x%x%x%x", at) then at = at + 6
    elseif text:find('^\\["\\/bfnrt]', at) then at = at + 2
    elseif text:find('^[^%c"\\]', at) then at = at + 1
    else error(("no JSON text at byte %d"):format(at), 0) end
  end
  at = at + 1
  skip()
end
local function list(close, item)
  at = at + 1
  skip()
  if text:sub(at, at) ~= close then
    item()
    while text:sub(at, at) == "," do take "," item() end
  end
  take("%" .. close)
end
function value()
  local c = text:sub(at, at)
  if c == "{" then list("}", function()
    if text:sub(at, at) ~= '"' then error("a key expected", 0) end
    word() take ":" value()
  end)
  elseif c == "[" then list("]", value)
  elseif c == '"' then word()
  elseif text:find("^true", at) then take "true"
  elseif text:find("^false", at) then take "false"
  elseif text:find("^null", at) then take "null"
  else
    local from = at
    take "%-?%d+%.?%d*[eE]?[+-]?%d*"
    assert(tonumber(text:sub(from, at - 1):match "%S+"), "a number expected")
  end
end
skip()
value()
assert(at > #text, "more than one value")
EOF
is_json() { # NAME FILE
  if "$program" run json.lua --trust --set file="$2" >"$work/check" 2>&1; then ok "$1"; else bad "$1" "$(cat "$work/check")"; fi
}

# ---------------------------------------------------------------- words of the command line

expect "--help" 0 "" "$program" --help
says "--help lists run" "venule run SCRIPT"
expect "help" 0 "" "$program" help
expect "--version" 0 "" "$program" --version
says "--version says which" "venule 0."
expect "unknown command" 2 'unknown command "rnu", did you mean "run"?' "$program" rnu leaf.lua
expect "unknown command, nothing like it" 2 'unknown command "xyzzyxyzzy"' "$program" xyzzyxyzzy
expect "unknown option" 2 "unknown option --sede, did you mean --seed?" "$program" run leaf.lua --sede 3
expect "unknown option before the script" 2 "unknown option --quite, did you mean --quiet?" "$program" run --quite leaf.lua
expect "no script" 2 "which script?" "$program" run
expect "two scripts" 2 "a second script" "$program" run leaf.lua json.lua
expect "no value" 2 "--seed" "$program" run leaf.lua --seed
expect "--time that is none" 2 "--time" "$program" run leaf.lua --time soon
expect "--time 0" 2 "--time" "$program" run leaf.lua --time 0
expect "--time nan" 2 "--time" "$program" run leaf.lua --time nan
expect "--memory that is none" 2 "--memory" "$program" run leaf.lua --memory much
expect "--memory 0" 2 "--memory" "$program" run leaf.lua --memory 0
expect "--threads 0" 2 "--threads" "$program" run leaf.lua --threads 0
expect "--threads 2.5" 2 "--threads" "$program" run leaf.lua --threads 2.5
expect "--set without =" 2 "NAME=VALUE" "$program" run leaf.lua --set kill_distance
expect "a missing script" 4 "missing.lua" "$program" run missing.lua
expect "a folder for a script" 4 "in" "$program" run "$work/in"
"$program" >"$work/out" 2>"$work/err"
if [ $? -eq 2 ] && grep -q "venule run" "$work/err"; then ok "no words: the help, exit 2"; else bad "no words" "$(head -c 200 "$work/err")"; fi

# ---------------------------------------------------------------- results

expect "run, every format" 0 "" "$program" run leaf.lua -o "$to/a.svg" -o "$to/a.png" -o "$to/a.pdf" -o "$to/a.json"
says "the paths are printed" "$to/a.svg"
says "and the count" "nodes"
empty "nothing on stderr that is no terminal" "$work/err"
begins "svg" "$to/a.svg" "<?xml"
begins "pdf" "$to/a.pdf" "%PDF-"
if [ "$(head -c 4 "$to/a.png" | od -An -tx1 | tr -d ' \n')" = 89504e47 ]; then ok "png"; else bad "png" "no signature"; fi
is_json "the network is JSON" "$to/a.json"
if command -v xmllint >/dev/null; then
  if xmllint --noout "$to/a.svg" 2>"$work/check"; then ok "the svg is XML"; else bad "the svg is XML" "$(head -3 "$work/check")"; fi
fi
expect "venule SCRIPT" 0 "" "$program" leaf.lua -o "$to/b.svg"
same "is venule run SCRIPT" "$to/a.svg" "$to/b.svg"
expect "options first, with =" 0 "" "$program" run --seed=1 --set kill_distance=2 leaf.lua -o "$to/c.svg" --output "$to/c.json"
same "--seed 1 is the default" "$to/a.svg" "$to/c.svg"
expect "another seed" 0 "" "$program" run leaf.lua --seed 2 -o "$to/d.json"
if cmp -s "$to/a.json" "$to/d.json"; then bad "grows another leaf" "the same"; else ok "grows another leaf"; fi
expect "--set seed" 0 "" "$program" run leaf.lua --set seed=2 -o "$to/e.json"
same "is --seed" "$to/d.json" "$to/e.json"
printf '{"kill_distance": 3.5, "name": "lung", "open": false, "seed": 2}\n' >params.json
expect "--params" 0 "" "$program" run leaf.lua --params params.json -o "$to/f.json"
holds "reach the script" "$to/f.json" '"kill_distance": 3.5'
expect "--set has the last word" 0 "" "$program" run leaf.lua --params params.json --set kill_distance=5 -o "$to/g.json"
holds "over --params" "$to/g.json" '"kill_distance": 5'
expect "--quiet" 0 "" "$program" run leaf.lua --quiet -o "$to/a.svg"
empty "--quiet prints nothing" "$work/out"
empty "--quiet says nothing" "$work/err"
expect "--json" 0 "" "$program" run leaf.lua --json -o "$to/h\"i.svg" -o "$to/a.png"
is_json "--json prints JSON" "$work/out"
if [ "$(wc -l <"$work/out")" -eq 1 ]; then ok "one line of it"; else bad "one line of JSON" "$(wc -l <"$work/out")"; fi
says "--json counts" '"nodes": '
expect "info" 0 "" "$program" info "$to/a.json"
says "info counts" "bifurcations"
says "info measures leaves" "vein density"
says "info measures vessels" "from order to order: counts by"
says "info counts boxes" "dimension "
expect "info --json" 0 "" "$program" info "$to/a.json" --json
is_json "info --json prints JSON" "$work/out"
says "with vessels" '"vessels": {"exponent": '
says "and boxes" '"boxes": {"dimension": '
cd "$to" && rm -rf ./* && expect "without -o" 0 "" "$program" run "$work/in/leaf.lua"
if [ "$(left)" = leaf.png ]; then ok "a file called after the script"; else bad "a file called after the script" "$(left)"; fi
if ls -A "$to" | grep -q '\.part'; then bad "no part is left" "$(left)"; else ok "no part is left"; fi
cd "$work/in" || exit 1

expect "run SCRIPT --help" 0 "" "$program" run leaf.lua --help
says "lists parameters" "kill_distance"
says "with ranges" "from 0.5 to 40 mm"
says "with defaults and help" "a vein this close consumes a source"
says "with the seed" "seed"
says "and with choices" "lung"
expect "run SCRIPT -h" 0 "" "$program" run leaf.lua -h
empty "--help runs nothing" "$work/err"
rm -rf "$to"; mkdir "$to"

# ---------------------------------------------------------------- formats of networks

expect "-o of each format" 0 "" "$program" run leaf.lua -o "$to/a.json" -o "$to/a.xml" -o "$to/a.vtp" -o "$to/a.swc" -o "$to/a.csv" -o "$to/a.txt"
begins "-o .xml writes GXL" "$to/a.xml" "<!-- venule manifest {"
holds "with the manifest" "$to/a.vtp" "kill_distance"
expect "info of XML" 0 "" "$program" info "$to/a.xml"
says "info counts its nodes" "bifurcations"
for format in xml vtp; do
  expect "convert to .$format" 0 "" "$program" convert "$to/a.json" "$to/b.$format"
  expect "convert from .$format" 0 "" "$program" convert "$to/b.$format" "$to/c.json"
  expect "convert to .$format again" 0 "" "$program" convert "$to/c.json" "$to/c.$format"
  sed '/Name="Order"/,/DataArray>/d; s/"[:,] "/":"/g' "$to/b.$format" >"$to/b" # orders are not read
  sed 's/"[:,] "/":"/g' "$to/c.$format" >"$to/c"
  same "convert loses nothing by .$format" "$to/b" "$to/c"
done
rm -rf "$to"; mkdir "$to"
cat >pair.json <<'EOF'
{"format": "venule.networks", "version": 1, "networks": {
"a": {"dim": 2, "nodes": {"x": [0, 1], "y": [0, 0], "parent": [-1, 0]}},
"v": {"dim": 2, "nodes": {"x": [0, 1], "y": [5, 5], "parent": [-1, 0]}}}}
EOF
expect "convert of two networks" 1 "pair.vtp: such a file holds one network, not 2; save each to its own, or all as .json" \
  "$program" convert pair.json "$to/pair.vtp"
expect "convert of two networks to JSON" 0 "" "$program" convert pair.json "$to/pair.json"
rm -rf "$to"; mkdir "$to"
printf '<gxl><graph>\n<node id="a"/>\n</graph></gxl>\n' >broken.xml
expect "convert of a broken file" 4 'broken.xml: line 2: node "a" has no position' "$program" convert broken.xml "$to/a.json"
expect "convert of a missing file" 4 "none.vtp: cannot be read" "$program" convert none.vtp "$to/a.json"
expect "convert to an unknown extension" 1 "a.stl: networks are written as .json, .xml," "$program" convert pair.json "$to/a.stl"
expect "convert of one file" 2 "venule convert IN OUT" "$program" convert pair.json
script looped <<'EOF'
local venule = require "venule"
local net = venule.network {}
net:root(0, 0)
net:add(1, 1, 0)
net:add(2, 1, 1)
net:join(1, 3)
venule.result {network = net}
EOF
expect "-o of a format without loops" 2 "a.swc: such a file holds trees, but 1 joins close loops" "$program" run looped.lua -o "$to/a.vtp" -o "$to/a.swc"

# ---------------------------------------------------------------- parameters that are wrong

expect "--set of an unknown name" 2 '--set kil_distance: this script has no such parameter, did you mean "kill_distance"?' \
  "$program" run leaf.lua --set kil_distance=3 -o "$to/a.svg"
expect "--set of a word for a number" 2 "--set kill_distance=much: number expected" "$program" run leaf.lua --set kill_distance=much -o "$to/a.svg"
expect "--set of nothing" 2 "--set kill_distance" "$program" run leaf.lua --set kill_distance= -o "$to/a.svg"
expect "--set nan" 2 "--set kill_distance" "$program" run leaf.lua --set kill_distance=nan -o "$to/a.svg"
expect "--set below" 2 "--set kill_distance = 0 must be from 0.5 to 40 mm: a vein this close consumes a source" \
  "$program" run leaf.lua --set kill_distance=0 -o "$to/a.svg"
expect "--set above" 2 "--set kill_distance = 1e+09 must be from 0.5 to 40 mm" "$program" run leaf.lua --set kill_distance=1e9 -o "$to/a.svg"
expect "--set of another choice" 2 '--set name = "tree" must be one of leaf, lung' "$program" run leaf.lua --set name=tree -o "$to/a.svg"
expect "--set of no boolean" 2 "--set open=maybe: boolean expected" "$program" run leaf.lua --set open=maybe -o "$to/a.svg"
expect "--seed of a word" 2 "seed" "$program" run leaf.lua --seed seven -o "$to/a.svg"
expect "--seed of a fraction" 2 "seed" "$program" run leaf.lua --seed 1.5 -o "$to/a.svg"
expect "--params of a missing file" 4 "none.json" "$program" run leaf.lua --params none.json -o "$to/a.svg"
printf '{"kill_distance": ' >broken.json
expect "--params that are no JSON" 4 "broken.json" "$program" run leaf.lua --params broken.json -o "$to/a.svg"
printf '{"kill_distance": [1]}' >list.json
expect "--params with a list" 4 "list.json" "$program" run leaf.lua --params list.json -o "$to/a.svg"
printf '{"kil_distance": 1}' >name.json
expect "--params of an unknown name" 2 'did you mean "kill_distance"?' "$program" run leaf.lua --params name.json -o "$to/a.svg"
expect "-o of an unknown extension" 2 "a.gif: unknown extension" "$program" run leaf.lua -o "$to/a.gif"
expect "-o of an unknown extension after a good one" 2 "a.gif: unknown extension" "$program" run leaf.lua -o "$to/a.svg" -o "$to/a.gif"
expect "-o without an extension" 2 "unknown extension" "$program" run leaf.lua -o "$to/a"

# ---------------------------------------------------------------- a script's mistakes, with its line

fails() { # NAME STATUS LINE TEXT: the script of that name; with a line, the message begins with it
  expect "$1" "$2" "$4" "$program" run "$1.lua" -o "$to/a.svg" -o "$to/a.json"
  if [ -n "$3" ] && ! grep -qF -e "venule: $1.lua:$3: " "$work/err"; then bad "$1: its line" "$(head -c 200 "$work/err")"; fi
}

one() { # NAME STATUS TEXT: line 2 of stdin's two lines is wrong
  cat >"$1.lua"
  fails "$1" "$2" 2 "$3"
}

printf 'local venule = require "venule"\nlocal x = = 3\n' >syntax.lua
fails syntax 1 2 "unexpected symbol"
one nil_call 1 "attempt to call a nil value" <<'EOF'
local venule = require "venule"
grow {}
EOF
one unknown_function 1 'venule has no "netwrok", did you mean "network"?' <<'EOF'
local venule = require "venule"
venule.netwrok {}
EOF
one unknown_domain 1 'venule.domain has no "dsik", did you mean "disk"?' <<'EOF'
local venule = require "venule"
venule.domain.dsik {}
EOF
one own_error 1 "too small" <<'EOF'
local venule = require "venule"
error("too small")
EOF
one unknown_field 1 'disk: unknown field "raduis", did you mean "radius"?' <<'EOF'
local venule = require "venule"
venule.domain.disk {raduis = 1}
EOF
one tail_call 1 "disk.radius = 0 must be above 0 length" <<'EOF'
local venule = require "venule"
return venule.domain.disk {radius = 0}
EOF
one missing_svg 4 "missing.svg" <<'EOF'
local venule = require "venule"
venule.domain.svg "missing.svg"
EOF
for name in unclosed bad-path empty no-shapes entity-bomb cyclic-use; do
  printf 'local venule = require "venule"\nvenule.domain.svg "%s"\n' "$source/tests/files/svg/$name.svg" >svg.lua
  expect "svg: $name" 4 "$name.svg" "$program" run svg.lua -o "$to/a.svg"
done
one crossing_svg 1 "cross" <<EOF
local venule = require "venule"
venule.domain.svg "$source/tests/files/svg/crossing.svg"
EOF
one empty_outline 1 "polygon: the outline is empty" <<'EOF'
local venule = require "venule"
venule.domain.polygon {}
EOF
one no_area 1 "has no area" <<'EOF'
local venule = require "venule"
venule.domain.polygon {{0, 0}, {1, 1}, {2, 2}}
EOF
one crossing 1 "cross" <<'EOF'
local venule = require "venule"
venule.domain.polygon {{0, 0}, {2, 2}, {2, 0}, {0, 2}}
EOF
script in_units <<'EOF'
local venule = require "venule"
local p = venule.param {{"unit", "mm"}}
local net = venule.network {unit = p.unit}
net:root(0, 0)
net:add(1, 88, 88)
venule.result {network = net, width = 900, height = 900}
EOF
expect "a network in mm" 0 "" "$program" run in_units.lua -o "$to/mm.svg"
holds "its page is at true scale" "$to/mm.svg" 'width="90mm"'
expect "a network in cells" 0 "" "$program" run in_units.lua --set unit=cells -o "$to/cells.svg"
holds "its page has 96 pixels an inch" "$to/cells.svg" 'width="238.125mm"'
rm "$to/mm.svg" "$to/cells.svg"
script root_outside <<'EOF'
local venule = require "venule"
local disk = venule.domain.disk {}
local s = venule.venation {domain = disk, rng = venule.rng(1), darts = 1, birth_distance = 0.1, roots = {{3, 0}}}
s:run()
EOF
fails root_outside 1 4 "extend: the root at (3, 0, 0) is outside the domain, by 2"
one birth_0 1 "throw.spacing = 0 must be above 0 length: birth distance" <<'EOF'
local venule = require "venule"
venule.attractors {}:throw {domain = venule.domain.disk {}, count = 9, spacing = 0, rng = venule.rng(1)}
EOF
one venation_birth_0 1 "venation.birth_distance = 0 must be above 0 length" <<'EOF'
local venule = require "venule"
venule.venation {domain = venule.domain.disk {}, birth_distance = 0, darts = 1, rng = venule.rng(1)}
EOF
one nan 1 "disk.radius is not a number (NaN)" <<'EOF'
local venule = require "venule"
venule.domain.disk {radius = 0 / 0}
EOF
one string_for_number 1 'disk.radius: number expected, got string' <<'EOF'
local venule = require "venule"
venule.domain.disk {radius = "1"}
EOF
one needle 3 "no dart of a million hit the polygon" <<'EOF'
local venule = require "venule"
venule.attractors {}:throw {domain = venule.domain.polygon {{0, 0}, {1e6, 1e6}, {1e6, 1e6 + 1e-6}}, count = 9, rng = venule.rng(1)}
EOF
one eroded 1 "growth would erode it" <<'EOF'
local venule = require "venule"
venule.growth.marginal {domain = venule.domain.polygon {{0, 0}, {20, 0}, {20, 20}, {5, 20}, {5, 15}, {15, 15}, {15, 5}, {0, 5}}}
EOF
printf 'local venule = require "venule"\nvenule.network {}:root(0, 0)\n' >unwritten.lua
fails unwritten 1 "" "-o $to/a.svg was not written"
printf 'local venule = require "venule"\nvenule.result {picture = function() end, width = 9}\n' >no_network.lua
expect "-o .json without a network" 2 "gives no network" "$program" run no_network.lua -o "$to/a.json"
expect "-o .json without a network, after a picture" 2 "gives no network" "$program" run no_network.lua -o "$to/a.svg" -o "$to/a.json"
one in_picture 1 "unknown field" <<'EOF'
local venule = require "venule"
venule.result {network = venule.network {}, width = 100, picture = function(c) c:fill(venule.domain.disk {}, {colour = "red"}) end}
EOF
expect "a missing folder" 4 "$to/none/a.svg: cannot be written" "$program" run leaf.lua -o "$to/none/a.svg"
expect "a missing folder, json" 4 "$to/none/a.json: cannot be written" "$program" run leaf.lua -o "$to/none/a.json"
expect "a folder that takes no files" 4 "/proc/a.svg: cannot be written" "$program" run leaf.lua -o /proc/a.svg
expect "a folder in place of a file" 4 "is a folder" "$program" run leaf.lua -o "$work/folder.svg"
mkdir "$work/readonly"
chmod 555 "$work/readonly"
if [ "$(id -u)" -ne 0 ]; then
  expect "a read-only folder" 4 "$work/readonly/a.svg: cannot be written" "$program" run leaf.lua -o "$work/readonly/a.svg"
fi
if [ -w /dev/full ]; then
  "$program" --help >/dev/full 2>"$work/err"
  "$program" run leaf.lua --json -o "$to/a.svg" >/dev/full 2>"$work/err"
  if [ $? -eq 4 ]; then ok "stdout that is full: exit 4"; else bad "stdout that is full" "not exit 4"; fi
  rm -f "$to/a.svg"
fi

# An old file stays as it is when the run fails.
echo old >"$to/a.svg"
"$program" run unwritten.lua -o "$to/a.svg" >/dev/null 2>&1
if [ "$(cat "$to/a.svg")" = old ] && [ "$(left)" = a.svg ]; then ok "a failed run keeps the old file"; else bad "a failed run keeps the old file" "$(left)"; fi
rm -f "$to/a.svg"

# ---------------------------------------------------------------- limits

script loop <<'EOF'
while true do end
EOF
script pcall_loop <<'EOF'
while true do pcall(function() while true do end end) end
EOF
script coroutine_loop <<'EOF'
local co = coroutine.wrap(function() while true do end end)
co()
EOF
script coroutine_pcall_loop <<'EOF'
while true do
  pcall(function() coroutine.wrap(function() while true do pcall(function() while true do end end) end end)() end)
end
EOF
script coroutines_by_the_dozen <<'EOF'
while true do
  local co = coroutine.create(function() local x = 0 for i = 1, 100 do x = x + i end coroutine.yield(x) end)
  pcall(coroutine.resume, co)
end
EOF
script close_loop <<'EOF'
local function guard() return setmetatable({}, {__close = function() while true do end end}) end
pcall(function() local g <close> = guard() while true do end end)
EOF
script pattern_loop <<'EOF'
return (("a"):rep(60) .. "b"):find(("a*"):rep(40) .. "c")
EOF
script throw_loop <<'EOF'
local venule = require "venule"
venule.attractors {}:throw {domain = venule.domain.disk {}, count = 2000000000, spacing = 0.001, rng = venule.rng(1)}
EOF
script sample_loop <<'EOF'
local venule = require "venule"
while true do pcall(function() venule.domain.disk {}:sample(100000000, {spacing = 0.01, rng = venule.rng(1)}) end) end
EOF
script step_loop <<'EOF'
local venule = require "venule"
local net, auxin = venule.network {}, venule.attractors {}
net:root(0, 0)
auxin:add(1e9, 1)
while true do
  local f = auxin:influence(net)
  net:extend(f, {length = 1e-3})
  venule.frame()
end
EOF
for name in loop pcall_loop coroutine_loop coroutine_pcall_loop coroutines_by_the_dozen close_loop pattern_loop throw_loop \
  sample_loop step_loop; do
  before=$(date +%s)
  expect "--time: $name" 5 "time" timeout 20 "$program" run $name.lua --time 1 -o "$to/a.svg"
  after=$(date +%s)
  if [ $((after - before)) -gt 5 ]; then bad "--time: $name ends" "after $((after - before)) s"; fi
done

script eat_tables <<'EOF'
local t = {}
for i = 1, 1e12 do t[i] = {i} end
EOF
script eat_text <<'EOF'
local s = "x"
while true do s = s .. s end
EOF
script eat_attractors <<'EOF'
local venule = require "venule"
venule.attractors {}:throw {domain = venule.domain.disk {}, count = 2000000000, rng = venule.rng(1)}
EOF
script eat_nodes <<'EOF'
local venule = require "venule"
local net = venule.network {}
net:root(0, 0)
for i = 1, 1e9 do net:add(i, i, 0) end
EOF
script eat_in_pcall <<'EOF'
local t = {}
pcall(function() for i = 1, 1e12 do t[i] = {i} end end)
for i = 1, 1e12 do t[#t + 1] = {i} end
EOF
script eat_canvas <<'EOF'
local venule = require "venule"
local c = venule.canvas {width = 100, height = 100}
for i = 1, 1e9 do c:dots {{1, 1}} end
EOF
eaters="eat_tables eat_text eat_attractors eat_in_pcall"
if ! grep -qa __asan_init "$program"; then eaters="$eaters eat_nodes eat_canvas"; fi # minutes of a sanitizer's bookkeeping
for name in $eaters; do
  expect "--memory: $name" 5 "memory" timeout 60 "$program" run $name.lua --memory 50M -o "$to/a.svg"
done
expect "a leaf within its limits" 0 "" "$program" run leaf.lua --memory 300M --time 60 -o "$to/a.svg"
rm -f "$to/a.svg"

# ---------------------------------------------------------------- Ctrl-C

interrupts() { # NAME
  "$program" run "$1.lua" -o "$to/a.svg" >"$work/out" 2>"$work/err" </dev/null &
  pid=$!
  sleep 0.5
  kill -INT $pid 2>/dev/null
  (sleep 10; kill -KILL $pid 2>/dev/null) &
  guard=$!
  wait $pid
  got=$?
  kill $guard 2>/dev/null
  wait $guard 2>/dev/null
  if [ $got -ne 130 ]; then bad "Ctrl-C: $1" "exit status $got: $(head -c 200 "$work/err")"
  elif ! grep -q "interrupted" "$work/err"; then bad "Ctrl-C: $1" "no word of it: $(head -c 200 "$work/err")"
  elif [ -n "$(left)" ]; then bad "Ctrl-C: $1" "left behind: $(left)"
  else ok "Ctrl-C: $1"; fi
  rm -rf "$to"; mkdir "$to"
}
for name in loop pcall_loop coroutine_pcall_loop throw_loop step_loop; do interrupts $name; done

# ---------------------------------------------------------------- progress, only on a terminal

script slow <<'EOF'
local venule = require "venule"
local net = venule.network {}
net:root(0, 0)
local stop = os.clock() + 0.5
while os.clock() < stop do venule.frame(0.5) end
venule.note("nearly there")
venule.result {network = net}
EOF
expect "no progress in a file" 0 "note: nearly there" "$program" run slow.lua -o "$to/a.json"
if [ "$(cat "$work/err")" = "note: nearly there" ]; then ok "only the note"; else bad "only the note" "$(head -c 200 "$work/err")"; fi
expect "--quiet without the note" 0 "" "$program" run slow.lua --quiet -o "$to/a.json"
empty "--quiet and notes" "$work/err"
if [ -n "$pty" ] && "$pty" -qec true /dev/null >/dev/null 2>&1 </dev/null; then
  "$pty" -qec "'$program' run slow.lua -o '$to/a.json'" /dev/null >"$work/out" 2>&1 </dev/null
  if grep -q "step .* nodes" "$work/out"; then ok "progress on a terminal"; else bad "progress on a terminal" "$(head -c 200 "$work/out")"; fi
  "$pty" -qec "'$program' run slow.lua --quiet -o '$to/a.json'" /dev/null >"$work/out" 2>&1 </dev/null
  if grep -q "step" "$work/out"; then bad "--quiet on a terminal" "$(head -c 200 "$work/out")"; else ok "--quiet on a terminal"; fi
else
  skip "progress on a terminal" "no script(1)"
fi
rm -f "$to/a.json"

# ---------------------------------------------------------------- how a file was made

"$program" run leaf.lua --set kill_distance=3.25 --seed 12 --quiet -o "$to/a.svg" -o "$to/a.png" -o "$to/a.pdf" -o "$to/a.json"
hash=$(sha256sum leaf.lua | cut -d' ' -f1)
if command -v xmllint >/dev/null; then # as a reader of XML sees it
  xmllint --xpath 'string(//*[local-name()="metadata"])' "$to/a.svg" >"$work/manifest" 2>/dev/null
else
  sed 's/&quot;/"/g' "$to/a.svg" >"$work/manifest"
fi
for kind in json png pdf svg; do
  file=$to/a.$kind
  if [ $kind = svg ]; then file=$work/manifest; fi
  for text in leaf.lua "$hash" kill_distance 3.25; do holds "manifest in $kind: $text" "$file" "$text"; done
done
rm -rf "$to"; mkdir "$to"

# ---------------------------------------------------------------- the sandbox

script sandbox <<'EOF'
local venule = require "venule"
local found = {}
local function absent(name, value) if value ~= nil then found[#found + 1] = name end end
absent("io", io)
absent("debug", debug)
absent("dofile", dofile)
absent("loadfile", loadfile)
absent("string.dump", string.dump)
for _, name in ipairs {"execute", "remove", "rename", "exit", "getenv", "tmpname", "setlocale"} do absent("os." .. name, os[name]) end
for _, name in ipairs {"loadlib", "cpath", "path", "searchpath"} do absent("package." .. name, package[name]) end
for name in pairs(package.loaded) do
  if name == "io" or name == "debug" then found[#found + 1] = "package.loaded." .. name end
end
for _, name in ipairs {"io", "debug", "ffi", "luaunit", "lfs", "../leaf", "/etc/passwd", "a..b", "posix"} do
  if pcall(require, name) then found[#found + 1] = "require " .. name end
end
absent("os.execute by require", require "os".execute)
local ok = pcall(load, "\27Lua")
local f = ok and load("\27LuaT\0\x19\x93\r\n\x1a\n")
absent("bytecode", f)
absent("bytecode by a function", (pcall(load, function() return nil end)) and load(function() return "\27Lua" end) or nil)
absent("metatable of strings by a library", getmetatable("").__metatable)
if #found > 0 then error("a stranger's script can reach " .. table.concat(found, ", ")) end
assert(load "return 1 + 1"() == 2)
assert(load("return x", "chunk", "t", {x = 5})() == 5)
assert(select(2, load "x ="))
assert(os.time() > 0 and os.clock() >= 0 and os.date "%Y")
venule.result {network = venule.network {}}
EOF
expect "the sandbox" 0 "" "$program" run sandbox.lua -o "$to/a.json"
script trusted <<'EOF'
local venule = require "venule"
assert(io.open and os.execute and os.getenv and debug.getinfo and dofile and loadfile and string.dump and package.path)
assert(require "io" == io and load(string.dump(function() return 3 end))() == 3)
assert(math.random() < 1)
venule.result {network = venule.network {}}
EOF
expect "--trust" 0 "" "$program" run trusted.lua --trust -o "$to/a.json"
rm -f "$to/a.json"
one random 1 "math.random() would not repeat; use venule.rng(seed)" <<'EOF'
local venule = require "venule"
local x = math.random()
EOF
one randomseed 1 "use venule.rng(seed)" <<'EOF'
local venule = require "venule"
math.randomseed(3)
EOF
printf '\033Lua' >bytecode.lua
expect "a script of bytecode" 1 "bytecode.lua" "$program" run bytecode.lua
mkdir -p parts/deep
printf 'return {answer = 42}\n' >parts/deep/module.lua
printf 'local m = require "parts.deep.module"\nlocal venule = require "venule"\nassert(m.answer == 42)\nvenule.result {network = venule.network {}}\n' >modules.lua
expect "a module beside the script" 0 "" "$program" run modules.lua -o "$to/a.json"
cd / && expect "from another folder" 0 "" "$program" run "$work/in/modules.lua" -o "$to/a.json"
cd "$work/in" || exit 1
rm -f "$to/a.json"

# ---------------------------------------------------------------- stock Lua

module=$(dirname "$program")/venule.so
if ! command -v lua5.4 >/dev/null; then
  skip "stock Lua" "no lua5.4"
elif [ ! -f "$module" ]; then
  bad "stock Lua" "no $module"
elif grep -qa __asan_init "$module"; then
  skip "stock Lua" "the module is built with sanitizers"
else
  cpath="package.cpath = '$(dirname "$program")/?.so'"
  expect "stock Lua" 0 "" lua5.4 -e "$cpath
    local v = require 'venule'
    local p = v.param {{'kill_distance', 5, min = 1, max = 9}}
    assert(p.kill_distance == 5 and p.seed == 1)
    v.frame()
    local net = v.network {murray = {}}
    net:root(0, 0)
    net:add(1, 3, 4)
    assert(net:measure().length == 5)
    net:save('$to/stock.json')
    assert(#v.load '$to/stock.json' == 2)
    print(v.version)"
  says "its version" "0."
  rm -f "$to/stock.json"
  expect "stock Lua: an error with its line" 1 "(command line):2: disk: unknown field" lua5.4 -e "$cpath
    local ok, e = pcall(function() require 'venule'.domain.disk {raduis = 1} end) io.stderr:write(e, '\n') os.exit(1)"
  rm -rf "$to"; mkdir "$to"
  sed "1i package.cpath = '$(dirname "$program")/?.so'" leaf.lua >stock.lua
  cd "$to" && lua5.4 "$work/in/stock.lua" >"$work/out" 2>"$work/err"
  if [ $? -eq 0 ] && [ "$(left)" = stock.png ]; then ok "stock Lua: a whole scenario"; else bad "stock Lua: a whole scenario" "$(left) $(head -c 300 "$work/err")"; fi
  cd "$work/in" || exit 1
fi
rm -rf "$to"; mkdir "$to"

# ---------------------------------------------------------------- the same bytes

for threads in 1 2 8; do
  "$program" run leaf.lua --quiet --threads $threads -o "$to/$threads.svg" -o "$to/$threads.png" -o "$to/$threads.json" -o "$to/$threads.pdf"
done
for kind in svg png json pdf; do
  same "$kind with 2 threads" "$to/1.$kind" "$to/2.$kind"
  same "$kind with 8 threads" "$to/1.$kind" "$to/8.$kind"
done
script many <<'EOF'
local venule = require "venule"
local auxin, net = venule.attractors {}, venule.network {murray = {}}
net:root(0, 0)
auxin:throw {domain = venule.domain.disk {}, count = 30000, spacing = 0.002, rng = venule.rng(3)}
for _ = 1, 100 do
  net:extend(auxin:influence(net), {length = 0.01})
  auxin:consume(net, {distance = 0.012})
end
venule.result {network = net}
EOF
for threads in 1 2 8; do "$program" run many.lua --quiet --threads $threads -o "$to/many$threads.json"; done
same "30,000 darts with 2 threads" "$to/many1.json" "$to/many2.json"
same "30,000 darts with 8 threads" "$to/many1.json" "$to/many8.json"

# A decimal comma, where the machine has such a locale or can make one.
comma=$(locale -a 2>/dev/null | grep -i -m1 '^de_DE.utf' || true)
if [ -z "$comma" ] && command -v localedef >/dev/null && localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" >/dev/null 2>&1; then
  LOCPATH=$work
  export LOCPATH
  comma=de_DE.UTF-8
fi
if [ -n "$comma" ]; then
  LC_ALL=$comma "$program" run leaf.lua --quiet --set kill_distance=2.0 -o "$to/c.svg" -o "$to/c.json" -o "$to/c.pdf"
  "$program" run leaf.lua --quiet --set kill_distance=2.0 -o "$to/d.svg" -o "$to/d.json" -o "$to/d.pdf"
  for kind in svg json pdf; do same "$kind under a decimal comma" "$to/d.$kind" "$to/c.$kind"; done
  LC_ALL=$comma "$program" run leaf.lua --json -o "$to/c.svg" >"$work/out" 2>"$work/err"
  is_json "--json under a decimal comma" "$work/out"
  if [ -f "$module" ] && command -v lua5.4 >/dev/null && ! grep -qa __asan_init "$module"; then
    cd "$to" && LC_ALL=$comma lua5.4 -e "os.setlocale '$comma'" "$work/in/stock.lua" 2>"$work/err" && mv stock.png comma.png &&
      lua5.4 "$work/in/stock.lua" && same "stock Lua under a decimal comma" "$to/stock.png" "$to/comma.png"
    cd "$work/in" || exit 1
  fi
else
  skip "a decimal comma" "no such locale, and localedef cannot make one"
fi

# ---------------------------------------------------------------- an organ that is full before its tree is whole

script full <<'EOF'
local venule = require "venule"
local p = venule.param {{"terminals", 500}, {"viscosity", 3.6e-3}, {"take", false}}
local tree = venule.cco {terminals = p.terminals, perfusion = 200, viscosity = p.viscosity, seed = p.seed}
local whole, why = tree:run()
if p.take then venule.shortfall(nil) end
venule.result {network = tree.network}
EOF
"$program" run full.lua --seed 3 -o "$to/full.xml" -o "$to/full.json" >"$work/out" 2>"$work/err"
if [ $? -eq 3 ]; then ok "a full organ: exit 3"; else bad "a full organ: exit 3" "$(head -c 300 "$work/err")"; fi
says "a full organ: what was written" full.xml
holds "a full organ: why" "$work/err" "note: cco: no place for terminal "
holds "a full organ: how many" "$work/err" " of 500 terminals found a place; what there is was written"
holds "a full organ: the tree as GXL, with resistances" "$to/full.xml" resistance
holds "a full organ: the tree as JSON" "$to/full.json" '"flow"'
"$program" run full.lua --seed 3 --quiet -o "$to/full.json" >"$work/out" 2>"$work/err"
if [ $? -eq 3 ] && [ "$(wc -l <"$work/err")" -eq 1 ]; then ok "a full organ, quietly"; else bad "a full organ, quietly" "$(head -c 300 "$work/err")"; fi
expect "a full organ that the script is content with" 0 "" "$program" run full.lua --seed 3 --set take=true --quiet -o "$to/full.json"
expect "an organ with room" 0 "" "$program" run full.lua --set terminals=5 -o "$to/some.json"

if [ -n "$(find "$work" -name '*.part')" ]; then bad "no part anywhere" "$(find "$work" -name '*.part')"; else ok "no part anywhere"; fi
echo "$checks checks, $failures failed"
[ $failures -eq 0 ]
