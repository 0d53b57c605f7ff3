// Every allocation of a whole scenario fails once, from Lua's first to the picture's last: always a clean
// error, never a crash, and not a byte is lost.

#include "support.h"

#include "bind/bind.h"
#include "host/host.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char scenario[] =
    "local venule, folder, begin = require 'venule', ...\n"
    "begin()\n"
    "local shape = venule.domain.polygon {{0, 0}, {6, 4}, {4, 9}, {0, 14}, {-4, 9}, {-6, 4}}\n"
    "shape = shape - venule.domain.disk {center = {9, 9}, radius = 1}\n"
    "local blade = venule.growth.marginal {domain = shape, origin = {0, 0}, from = 4, step = 5}\n"
    "local auxin, eaten = venule.attractors {}, venule.attractors {}\n"
    "local veins = venule.network {unit = 'mm', murray = {exponent = 2, tip_radius = 0.1}}\n"
    "local rng = venule.rng(3)\n"
    "veins:root(0, 0)\n"
    "repeat\n"
    "  local growing = blade:advance(veins, auxin)\n"
    "  auxin:throw {domain = blade, density = 1, spacing = 1, clearance = 1, network = veins, rng = rng}\n"
    "  for _ = 1, 4 do\n"
    "    local f = auxin:influence(veins, {within = 9})\n"
    "    for attractor, node in f:pairs() do assert(auxin.x[attractor] and veins.x[node]) end\n"
    "    veins:extend(f, {length = 0.5, domain = blade})\n"
    "    auxin:consume(veins, {distance = 0.6, into = eaten})\n"
    "  end\n"
    "  venule.frame()\n"
    "until not growing\n"
    "veins:orders 'hickey'\n"
    "assert(#veins > 10 and #eaten > 3 and veins:measure().nodes == #veins)\n"
    "veins:join(2, #veins)\n"
    "veins:orders('hickey', {ratio = 0.5})\n"
    "assert(veins:measure({leaf = true, domain = shape, resolution = 1}).leaf.area > 10)\n"
    "assert(tostring(veins:flow {}):find 'conservation' and veins.pressure[1] > veins.pressure[#veins])\n"
    "assert(veins:flow({solve = false}).inflow == veins.flow[1] and veins:joins()[1].flow)\n"
    "assert(veins:levels()[1].flow.mean > 0)\n"
    "assert(#veins:measure_vessels({orders = 'diameter', bins = 3}).angles.bins == 3)\n"
    "assert(#veins:measure_boxes({finest = 4, offsets = 2}).boxes == 3)\n"
    "assert(#veins:measure_tissue({domain = blade, resolution = 1, bins = 4}).histogram == 4)\n"
    "local laid = venule.network {}\n"
    "assert(laid:follow({{{0, 0}, {3, 1}}, {{1, 0.3}, {1, 4}}}, {length = 0.5}) > 10)\n"
    "assert(#venule.paths(laid) == 3)\n"
    "local tree = venule.cco {terminals = 4, density = function() return 1 end,\n"
    "  terminal_flow = function() return 1 end, exponent = function() return 3 end}\n"
    "assert(#tree:run().network == 8 and tree.report.terminals == 4)\n"
    "tree = venule.cco {terminals = {{1, 2}, {3, 4}}, from = tree.network, avoid = {}}\n"
    "shape:sample(20, {spacing = 0.5, rng = rng})\n"
    "local sheet = {vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 1}}, faces = {{1, 2, 3, 4}}}\n"
    "venule.domain.mesh(sheet, {on = 'surface'}):sample(9, {rng = rng})\n"
    "local page = venule.canvas {view = blade:bounds(), width = 60, background = 'white'}\n"
    "page:fill(blade, {color = 'teal'})\n"
    "page:stroke(veins, {color = '#3d5c2b'})\n"
    "page:stroke(veins, {width = function(node) return 0.1 * veins.radius[node] end})\n"
    "page:dots(eaten)\n"
    "page:text('leaf', {at = {0, 1}})\n"
    "page:line({{0, 0}, {1, 1}, {2, 0}}, {fill = 'red'})\n"
    "local ball = venule.domain.sphere {}\n"
    "local space = venule.canvas {view = ball:bounds(), width = 60, camera = {fog = 0.5}}\n"
    "space:fill(ball, {opacity = 0.5})\n"
    "space:stroke(veins, {width = 0.1, color_by = 'birth'})\n"
    "space:stroke(veins, {width = 0.1, color_by = function() return 'red' end})\n"
    "space:save(folder .. '/space.svg')\n"
    "veins:save(folder .. '/leaf.json')\n"
    "for kind, content in pairs {nrrd = 'segment', ['nii.gz'] = 'vesselness'} do\n"
    "  local voxels = venule.voxels {networks = {a = veins}, size = 9, content = content, bounds = "
    "blade:bounds()}\n"
    "  voxels:save(folder .. '/leaf.' .. kind)\n"
    "end\n"
    "for _, kind in ipairs {'svg', 'png', 'pdf'} do page:save(folder .. '/leaf.' .. kind) end\n";

static const char reading[] = "local venule, folder, begin = require 'venule', ...\n"
                              "local a, b = venule.network {murray = {}}, venule.network {dim = 3}\n"
                              "a:root(0, 0) a:add(1, 1, 0) b:root(1, 2, 3)\n"
                              "venule.save(folder .. '/both.json', {a = a, b = b})\n"
                              "local page = venule.canvas {width = 40, height = 40}\n"
                              "page:fill(venule.domain.box {min = {5, 5}, max = {20, 30}})\n"
                              "page:save(folder .. '/page.svg')\n"
                              "begin()\n"
                              "local both = venule.load(folder .. '/both.json')\n"
                              "assert(#both.a == 2 and #both.b == 1)\n"
                              "assert(venule.domain.svg(folder .. '/page.svg'):measure() > 10)\n";

static const char blades[] =
    "local venule, _, begin = require 'venule', ...\n"
    "begin()\n"
    "local growth, shape = venule.growth, venule.domain.polygon {{0, 0}, {6, 4}, {0, 14}, {-6, 4}}\n"
    "local veins, auxin = venule.network {murray = {}}, venule.attractors {}\n"
    "local function f(y0) return 1.1 + y0 / 100 end\n"
    "veins:add(veins:root(0, 0), 1, 6)\n"
    "auxin:add(0, 7)\n"
    "local box = venule.domain.box {min = {-4, 0}, max = {4, 9}}\n"
    "for _, blade in ipairs {\n"
    "  growth.isogonic {domain = shape, split = 1}, growth.uniform {domain = shape, x = 1.1, steps = 2},\n"
    "  growth.rerg {domain = shape, x = f, y = {{0, 1}, {5, 1.2}, {9, 1.1}}, samples = 50, steps = 2},\n"
    "  growth.morph {domains = {shape, box}, samples = 20, steps = 2},\n"
    "} do\n"
    "  while blade:advance(veins, auxin) and blade.time < 3 do blade:map(0, 1, 0, 2) end\n"
    "end\n"
    "assert(#veins > 5 and #auxin == 1)\n";

static int64_t refuse_from; // the n-th allocation after begin(), or after the state was asked for
static bool from_the_start;
static bool begun;
static char folder[] = "/tmp/venule-XXXXXX";

static int begin(lua_State *L) {
    (void)L;
    begun = true;
    if (!from_the_start) {
        vn_fail_allocations_from(refuse_from);
    }
    return 0;
}

static int run_protected(lua_State *L) {
    const char *text = lua_touserdata(L, 1);
    sandbox_open(L, "test.lua", true);
    luaL_requiref(L, "venule", luaopen_venule, 0);
    lua_settop(L, 0);
    if (luaL_loadbufferx(L, text, strlen(text), "=scenario", "t") != LUA_OK) {
        return lua_error(L);
    }
    lua_pushstring(L, folder);
    lua_pushcfunction(L, begin);
    lua_call(L, 2, 0);
    return 0;
}

static void assert_clean(lua_State *L, int code) {
    assert_int_equal(lua_type(L, -1), LUA_TSTRING);
    const char *message = lua_tostring(L, -1);
    if (code != LUA_ERRMEM && strstr(message, "memory") == NULL) {
        fail_msg("allocation %lld refused: %s", (long long)refuse_from, message);
    }
    assert_null(strchr(message, '\n'));
}

// Whether the whole text ran with allocations refused from the n-th on.
static bool runs(const char *text, int64_t n) {
    size_t before = vn_byte_count();
    refuse_from = n;
    begun = false;
    vn_fail_allocations_from(from_the_start ? n : -1);
    lua_State *L = limits_new_state();
    int code = LUA_ERRMEM;
    if (L != NULL) {
        lua_pushcfunction(L, run_protected);
        lua_pushlightuserdata(L, (void *)(uintptr_t)text);
        code = lua_pcall(L, 1, 0, 0);
        vn_fail_allocations_from(-1);
        if (code != LUA_OK) {
            assert_clean(L, code);
        }
        lua_close(L);
    }
    vn_fail_allocations_from(-1);
    if (vn_byte_count() != before) {
        fail_msg("allocation %lld refused: %zu bytes lost", (long long)n, vn_byte_count() - before);
    }
    return code == LUA_OK;
}

static void assert_no_parts(void) {
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
        assert_null(strstr(entry->d_name, ".part"));
    }
    closedir(dir);
}

// Each of the first thousand, then at steps of a five-hundredth.
static void sweep(const char *text, bool whole) {
    int64_t n = 0;
    from_the_start = whole;
    while (!runs(text, n)) {
        assert_true(n < 10000000);
        n += 1 + (n > 1000 ? n / 500 : 0);
    }
    assert_true(begun);
    assert_true(n > 50);
    assert_no_parts();
}

static void test_scenario(void **state) {
    (void)state;
    sweep(scenario, false);
}

static void test_scenario_from_the_first_allocation(void **state) {
    (void)state;
    sweep(scenario, true);
}

static void test_reading(void **state) {
    (void)state;
    sweep(reading, false);
}

static void test_blades(void **state) {
    (void)state;
    sweep(blades, false);
}

// 4.5 MB each, of which Lua itself sees a pointer.
static const char many_volumes[] = "local venule = require 'venule'\n"
                                   "local net = venule.network {dim = 3, murray = {}}\n"
                                   "net:add(net:root(0, 0, 0), 10, 0, 0)\n"
                                   "for _ = 1, 60 do net:voxels {size = 200, margin = 70} end\n";

static void test_volumes_are_let_go(void **state) {
    (void)state;
    vn_byte_peak_reset();
    from_the_start = false;
    assert_true(runs(many_volumes, -1));
    assert_in_range(vn_byte_peak(), 4 << 20, 40 << 20);
}

static int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state) {
    (void)state;
    static const char *const names[] = {"leaf.json", "leaf.svg",  "leaf.png",    "leaf.pdf", "both.json",
                                        "page.svg",  "space.svg", "leaf.nii.gz", "leaf.nrrd"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    return rmdir(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scenario),
        cmocka_unit_test(test_scenario_from_the_first_allocation),
        cmocka_unit_test(test_reading),
        cmocka_unit_test(test_blades),
        cmocka_unit_test(test_volumes_are_let_go),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
