#include "bind/bind.h"

static void release_rng(void *object) {
    vn_resize(object, sizeof(vn_rng), 0);
}

static vn_rng *check_rng(lua_State *L) {
    return vnl_check(L, 1, &vnl_rng_class);
}

static int rng_uniform(lua_State *L) {
    vn_rng *rng = check_rng(L);
    double low = lua_gettop(L) >= 2 ? vnl_check_number(L, 2, "rng:uniform low") : 0;
    double high = lua_gettop(L) >= 3 ? vnl_check_number(L, 3, "rng:uniform high") : 1;
    if (!(low <= high)) {
        return vnl_fail(L, "rng:uniform(%g, %g): the first must not be above the second", low, high);
    }
    lua_pushnumber(L, vn_rng_uniform(rng, low, high));
    return 1;
}

static int rng_normal(lua_State *L) {
    vn_rng *rng = check_rng(L);
    double mean = lua_gettop(L) >= 2 ? vnl_check_number(L, 2, "rng:normal mean") : 0;
    double deviation = lua_gettop(L) >= 3 ? vnl_check_number(L, 3, "rng:normal sd") : 1;
    if (!(deviation >= 0)) {
        return vnl_fail(L, "rng:normal: a standard deviation of %g must be 0 or more", deviation);
    }
    lua_pushnumber(L, vn_rng_normal(rng, mean, deviation));
    return 1;
}

static int rng_integer(lua_State *L) {
    vn_rng *rng = check_rng(L);
    lua_Integer low = vnl_check_integer(L, 2, "rng:integer low");
    lua_Integer high = vnl_check_integer(L, 3, "rng:integer high");
    if (low > high) {
        return vnl_fail(L, "rng:integer(%lld, %lld): the first must not be above the second", (long long)low,
                        (long long)high);
    }
    lua_pushinteger(L, vn_rng_integer(rng, low, high));
    return 1;
}

static const vnl_function methods[] = {
    {"uniform", rng_uniform, "(low?: number, high?: number): number", NULL,
     "The next number in [low, high); without arguments in [0, 1).", NULL},
    {"normal", rng_normal, "(mean?: number, sd?: number): number", NULL,
     "The next normally distributed number; mean 0 and standard deviation 1 unless given.", NULL},
    {"integer", rng_integer, "(low: integer, high: integer): integer", NULL,
     "The next whole number from low to high, both included.", NULL},
    {0},
};

const vnl_class vnl_rng_class = {
    .name = "rng",
    .doc = "Random numbers that depend on nothing but their seed: `venule.rng(7)`.",
    .methods = methods,
    .release = release_rng,
};
