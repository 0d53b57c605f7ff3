// Files that say what cannot be: one line says what is wrong and where, and nothing stays in memory.
#include "files.h"

typedef struct lie {
    const char *extension;
    const char *text;
    const char *reason; // what the message must say
} lie;

#define NODE(id)                                                                                             \
    "<node id=\"" id "\"><attr name=\"position\"><tup><float>1</float><float>2</float></tup></attr></node>"
#define EDGE(from, to) "<edge from=\"" from "\" to=\"" to "\"/>"
#define GXL(body) "<gxl><graph>" body "</graph></gxl>"
#define PIECE(body)                                                                                          \
    "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\">" body "</Piece></PolyData></VTKFile>"
#define ARRAY(name, type, body)                                                                              \
    "<DataArray Name=\"" name "\" type=\"" type "\" format=\"ascii\">" body "</DataArray>"
#define POINT                                                                                                \
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 "                     \
    "0</DataArray></Points>"

static const lie lies[] = {
    {"gxl", "", "the file is empty"},
    {"gxl", "\n", "not XML"},
    {"gxl", "{\"format\": 1}", "line 1: not XML"},
    {"gxl", "<gxl><graph>", "not XML: it ends too early"},
    {"gxl", "<svg/>", "line 1: its outermost element is <svg>, not <gxl>"},
    {"gxl", "<gxl/>", "holds no <graph>"},
    {"gxl", "<gxl><graph/>\n<graph/></gxl>", "line 2: a second <graph>"},
    {"gxl", GXL("<node/>"), "<node> has no id"},
    {"gxl", GXL("<node id=\"a\"/>"), "node \"a\" has no position"},
    {"gxl", GXL(NODE("a") NODE(" a")), "node \"a\" is given twice"},
    {"gxl", GXL(NODE("a&#10;b") NODE("a&#10;b")), "node \"a?b\" is given twice"},
    {"swc", "1 0 \x1b[2J", "x = \"?[2J\" must be a number"},
    {"gxl", GXL("<node id=\"a\"><attr name=\"position\"><tup><float>1</float></tup></attr></node>"),
     "has no position"},
    {"gxl",
     GXL("<node id=\"a\"><attr "
         "name=\"position\"><tup><float>nan</float><float>1</float></tup></attr></node>"),
     "position = \"nan\" must be a number"},
    {"gxl", GXL("<node id=\"a\"><attr name=\"position\"><tup><float>1e999</float></tup></attr></node>"),
     "position = \"1e999\" must be a number"},
    {"gxl",
     GXL("<node id=\"a\"><attr "
         "name=\"position\"><tup><float>1</float><float>1</float><float>1</float><float>1"
         "</float></tup></attr></node>"),
     "more than three coordinates"},
    {"gxl",
     GXL(NODE(
         "a") "<node id=\"b\"><attr name=\"position\"><tup><float>1</float><float>1</float><float>1</float>"
              "</tup></attr></node>"),
     "node \"b\" has 3 coordinates, but those before it have 2"},
    {"gxl", GXL(NODE("a") EDGE("a", "b")), "an edge leads to \"b\", which is no node"},
    {"gxl", GXL(NODE("a") EDGE("b", "a")), "an edge leads from \"b\", which is no node"},
    {"gxl", GXL(NODE("a") EDGE("a", " a ")), "an edge leads from \"a\" to itself"},
    {"gxl", GXL(NODE("a") NODE("b") EDGE("a", "b") EDGE("b", "a")), "two edges connect node 1 with node 0"},
    {"gxl", GXL(NODE("a") "<edge from=\"a\"/>"), "<edge> has no to"},
    {"gxl",
     GXL(NODE("a")
             NODE("b") "<edge from=\"a\" to=\"b\"><attr name=\"radius\"><float>-1</float></attr></edge>"),
     "node 1 has the radius -1"},
    {"gxl",
     GXL(NODE("a") NODE("b") NODE("c") EDGE("a", "c") "<edge from=\"a\" to=\"b\"><attr name=\"flow\"><float>1"
                                                      "</float></attr></edge>"),
     "the edge to node 1 has a flow, but that to node 2 has none"},
    {"gxl", "<!DOCTYPE gxl [<!ENTITY a \"b\">]><gxl><graph>&a;</graph></gxl>",
     "not XML: Entity 'a' not defined"},
    {"gxl", "<!DOCTYPE gxl SYSTEM \"x.dtd\"><gxl><graph><node id=\"&a;\"/></graph></gxl>",
     "Entity 'a' not defined"},
    {"vtp", "", "the file is empty"},
    {"vtp", "<gxl/>", "not <VTKFile>"},
    {"vtp", "<VTKFile type=\"UnstructuredGrid\"/>", "holds no PolyData"},
    {"vtp", "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"/>",
     "packed by vtkLZ4DataCompressor"},
    {"vtp", "<VTKFile type=\"PolyData\"/>", "holds no <Piece>"},
    {"vtp", PIECE(""), "says that it has 1 points, but holds 0 coordinates"},
    {"vtp", "<VTKFile type=\"PolyData\"><Piece NumberOfPoints=\"1000000000\">" POINT "</Piece></VTKFile>",
     "says that it has 1e+09 points, but holds 3 coordinates"},
    {"vtp", PIECE(POINT "<PointData>" ARRAY("Radius", "Float64", "1 2") "</PointData>"),
     "Radius has 2 entries, but there are 1 points"},
    {"vtp", PIECE(POINT "<PointData>" ARRAY("Node", "Int32", "1") "</PointData>"),
     "Node[0] = 1 must be from 0 to 0"},
    {"vtp",
     PIECE(POINT "<Lines>" ARRAY("connectivity", "Int32", "0 1") ARRAY("offsets", "Int32", "2") "</Lines>"),
     "a line has point 1, but there are 1 points"},
    {"vtp",
     PIECE(POINT "<Lines>" ARRAY("connectivity", "Int32", "0 -1") ARRAY("offsets", "Int32", "2") "</Lines>"),
     "a line has point -1"},
    {"vtp",
     PIECE(POINT "<Lines>" ARRAY("connectivity", "Int32", "0 0") ARRAY("offsets", "Int32", "2 1") "</Lines>"),
     "line 1 ends at 1, but must from 2 to 2"},
    {"vtp", PIECE(POINT "<Lines>" ARRAY("connectivity", "Int32", "0 x") "</Lines>"),
     "\"x\" in an array must be"},
    {"vtp", PIECE("<Points>" ARRAY("Points", "Complex", "0") "</Points>"), "says that it has 1 points"},
    {"vtp",
     PIECE("<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
           "format=\"binary\">AAAA*</DataArray></Points>"),
     "which is not base64"},
    {"vtp",
     PIECE("<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
           "format=\"binary\">/////w==</DataArray></Points>"),
     "an array is shorter than it says"},
    {"vtp",
     PIECE("<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" "
           "offset=\"9\"/></Points>"),
     "an array begins at byte 9 of the 0 that are appended"},
    {"vtp",
     "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><Piece "
     "NumberOfPoints=\"1\"><Points><DataArray "
     "type=\"Float64\" NumberOfComponents=\"3\" "
     "format=\"binary\">////////////////</DataArray></Points></Piece></VTKFile>",
     "an array is shorter than it says"},
    {"vtp", "<VTKFile type=\"PolyData\"><AppendedData encoding=\"raw\"/></VTKFile>", "appends its data raw"},
    {"swc", "1 0 0 0 0 1", "line 1: parent is missing"},
    {"swc", "1 0 0 0 0 1 -1\n1 0 0 0 0 1 -1", "line 2: id 1 is given twice"},
    {"swc", "1 0 0 0 0 1 9", "parent 9 of node 0 is no node"},
    {"swc", "1 0 0 0 0 1 1", "node 0 has the parent 0"},
    {"swc", "1 0 0 0 0 1 2\n2 0 0 0 0 1 1", "run in a circle"},
    {"swc", "1 0 0 nan 0 1 -1", "line 1: y = \"nan\" must be a number"},
    {"swc", "1 0 0 0 0 -1 -1", "node 0 has the radius -1"},
    {"swc", "1.5 0 0 0 0 1 -1", "line 1: id = \"1.5\" must be a whole number"},
    {"swc", "9999999999 0 0 0 0 1 -1", "must be a whole number"},
    {"swc", "-3 0 0 0 0 1 -1", "line 1: id = -3 must be 0 or more"},
    {"csv", "", "the file is empty"},
    {"csv", "x,y\n1,2\n", "the header has no column parent"},
    {"csv", "x,x,y,parent\n", "the header has the column x twice"},
    {"csv", "x,y,parent\n1,2\n", "line 2: has 2 fields, but the header has 3"},
    {"csv", "x,y,parent\n1,2,3,4\n", "line 2: has 4 fields, but the header has 3"},
    {"csv", "x,y,parent\n1,,-1\n", "line 2: y = \"\" must be a number"},
    {"csv", "x,y,parent\n1,2,0.5\n", "line 2: parent = \"0.5\" must be a whole number"},
    {"csv", "x,y,parent\n1,2,7\n", "node 0 has the parent 7"},
    {"csv", "x,y,parent\n1,2,-2\n", "node 0 has the parent -2"},
    {"csv", "x,y,parent\n1,2,1\n1,2,0\n", "run in a circle"},
    {"csv", "x,y,parent\ninf,2,-1\n", "x = \"inf\" must be a number"},
    {"csv", "x,y,parent,birth\n1,2,-1,-4\n", "line 2: birth = -4 must be 0 or more"},
    {"csv", "x,y,parent,flow\n1,2,-1,\n1,2,0,3\n1,2,0,\n",
     "the edge to node 1 has a flow, but that to node 2"},
    {"txt", "1 2 3 4 5 6\n", "line 1: r = \"\" must be a number"},
    {"txt", "1 2 3 4 5 6 7 8\n", "line 1: has more than the seven numbers"},
    {"txt", "\n1 2 3 1 2 3 1\n", "line 2: the segment has no length"},
    {"txt", "1 2 3 4 5 6 -7\n", "has the radius -7"},
    {"txt", "1 2 3 4 5 6 1\n4 5 6 1 2 3 1", "two edges connect"},
};

static const char *const extensions[] = {"xml", "vtp", "swc", "csv", "txt"};

enum { LIES = sizeof lies / sizeof *lies, EXTENSIONS = sizeof extensions / sizeof *extensions };

static const char *named(const char *stem, const char *extension) {
    char name[32];
    snprintf(name, sizeof name, "%s.%s", stem, extension);
    return in_folder(name);
}

static void a_file_that_lies_is_refused(void **state) {
    (void)state;
    for (int i = 0; i < LIES; i++) {
        vn_network_set set;
        const char *path = named("lie", lies[i].extension);
        put_text(path, lies[i].text);
        vn_status status = vn_networks_load(&set, path);
        if (status != VN_IO || strstr(vn_message(), lies[i].reason) == NULL) {
            fail_msg("%s\n  gave %d \"%s\", not \"%s\"", lies[i].text, (int)status,
                     status != VN_OK ? vn_message() : "", lies[i].reason);
        }
        assert_int_equal(strncmp(vn_message(), path, strlen(path)), 0);
        assert_null(strchr(vn_message(), '\n'));
        assert_null(set.networks);
    }
}

static vn_network *network_for(const char *extension) {
    bool trees = strcmp(extension, "xml") != 0 && strcmp(extension, "vtp") != 0;
    if (strcmp(extension, "txt") == 0) {
        return random_tree(3, 12, 1, 3);
    }
    return full_forest(3, 12, trees ? 0 : 8, 3);
}

// A line may be whole where another one follows: then the file is good, and smaller.
static void a_file_that_was_cut_off_does_no_harm(void **state) {
    (void)state;
    for (int i = 0; i < EXTENSIONS; i++) {
        bool xml = i < 2;
        size_t size;
        vn_network *network = network_for(extensions[i]);
        save_one(network, named("a", extensions[i]), "{\"seed\": 7}");
        char *text = take_file(named("a", extensions[i]), &size);
        for (size_t cut = 0; cut + 2 < size; cut++) {
            vn_network_set set;
            size_t before = vn_byte_count();
            put_file(named("cut", extensions[i]), text, cut);
            vn_status status = vn_networks_load(&set, named("cut", extensions[i]));
            assert_true(status == VN_IO || (status == VN_OK && !xml));
            assert_true(status != VN_OK || vn_network_count(set.networks[0]) <= vn_network_count(network));
            vn_networks_free(&set);
            assert_int_equal(vn_byte_count(), before);
        }
        free(text);
        vn_network_destroy(network);
    }
}

static void a_spoiled_file_does_no_harm(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(11);
    for (int i = 0; i < EXTENSIONS; i++) {
        size_t size;
        int refused = 0;
        vn_network *network = network_for(extensions[i]);
        save_one(network, named("a", extensions[i]), "{\"seed\": 7}");
        char *text = take_file(named("a", extensions[i]), &size);
        for (int round = 0; round < 1500; round++) {
            vn_network_set set;
            size_t at[4];
            char was[4];
            for (int k = 0; k < 4; k++) {
                static const char bytes[] = "0123456789-+.e \n\t,;<>\"/&\0\xFFnx";
                at[k] = (size_t)whole(&rng, 0, (int64_t)size - 1);
                was[k] = text[at[k]];
                text[at[k]] = bytes[whole(&rng, 0, (int64_t)sizeof bytes - 2)];
            }
            put_file(named("cut", extensions[i]), text, size);
            vn_status status = vn_networks_load(&set, named("cut", extensions[i]));
            assert_true(status == VN_OK || status == VN_IO);
            refused += status != VN_OK;
            vn_networks_free(&set);
            for (int k = 3; k >= 0; k--) {
                text[at[k]] = was[k];
            }
        }
        assert_true(refused > 300);
        free(text);
        vn_network_destroy(network);
    }
}

// `count` times `body`, after `head`.
static void put_repeated(const char *path, const char *head, const char *body, size_t count) {
    FILE *file = fopen(path, "wb");
    fputs(head, file);
    for (size_t i = 0; i < count; i++) {
        fputs(body, file);
    }
    assert_int_equal(fclose(file), 0);
}

static void assert_refused(const char *path, vn_status status, const char *reason) {
    vn_network_set set;
    assert_int_equal(vn_networks_load(&set, path), status);
    assert_message(reason);
}

static void endless_files_are_refused(void **state) {
    (void)state;
    put_repeated(in_folder("a.gxl"), "<gxl>", "<a>", 100000);
    assert_refused(in_folder("a.gxl"), VN_IO, "not XML");
    put_repeated(in_folder("a.gxl"), "<gxl><graph><node id=\"a\"><attr name=\"position\"><float>", "1234",
                 100000);
    assert_refused(in_folder("a.gxl"), VN_IO, "position is longer than 256 bytes");
    put_repeated(in_folder("a.swc"), "1 0 ", "1234", 1 << 19);
    assert_refused(in_folder("a.swc"), VN_IO, "line 1: is longer than");
    put_repeated(in_folder("a.csv"), "x", ",", 100000);
    assert_refused(in_folder("a.csv"), VN_IO, "more than 4096 columns");
}

static void the_memory_budget_holds(void **state) {
    (void)state;
    put_repeated(in_folder("a.gxl"), "<gxl><graph>", EDGE("left", "right"), 200000);
    put_repeated(in_folder("a.vtp"),
                 "<VTKFile type=\"PolyData\"><Piece NumberOfPoints=\"9\"><Points><DataArray type=\"Float64\" "
                 "NumberOfComponents=\"3\" format=\"ascii\">",
                 "1 ", 1000000);
    put_repeated(in_folder("a.swc"), "1 0 0 0 0 1 -1", "\n0000 0 0 0 0 1 -1", 1);
    size_t before = vn_byte_count();
    vn_set_memory_budget(before + 2000000);
    vn_network_set set;
    vn_status gxl = vn_networks_load(&set, in_folder("a.gxl"));
    vn_status vtp = vn_networks_load(&set, in_folder("a.vtp"));
    vn_status swc = vn_networks_load(&set, in_folder("a.swc"));
    vn_set_memory_budget(0);
    assert_int_equal(gxl, VN_NO_MEMORY);
    assert_int_equal(vtp, VN_NO_MEMORY);
    assert_int_equal(swc, VN_OK);
    vn_networks_free(&set);
    assert_int_equal(vn_byte_count(), before);
}

static void no_failed_allocation_loses_memory(void **state) {
    (void)state;
    for (int i = 0; i < EXTENSIONS; i++) {
        vn_network *network = network_for(extensions[i]);
        const char *path = named("a", extensions[i]);
        vn_status saved = VN_NO_MEMORY, loaded = VN_NO_MEMORY;
        int refused = 0;
        for (int nth = 0; saved != VN_OK && nth < 1000; nth++) {
            size_t before = vn_byte_count();
            vn_fail_allocations_from(nth);
            saved = vn_network_save(network, path, "{\"viscosity\": 1}");
            vn_fail_allocations_from(-1);
            assert_true(saved == VN_OK || saved == VN_NO_MEMORY);
            assert_int_equal(vn_byte_count(), before);
        }
        assert_int_equal(saved, VN_OK);
        vn_network_destroy(network);
        for (int nth = 0; loaded != VN_OK && nth < 10000; nth++, refused++) {
            vn_network_set set;
            size_t before = vn_byte_count();
            vn_fail_allocations_from(nth);
            loaded = vn_networks_load(&set, path);
            vn_fail_allocations_from(-1);
            assert_true(loaded == VN_OK || loaded == VN_NO_MEMORY);
            vn_networks_free(&set);
            assert_int_equal(vn_byte_count(), before);
        }
        assert_int_equal(loaded, VN_OK);
        assert_true(refused > 10);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(a_file_that_lies_is_refused), counted_test(a_file_that_was_cut_off_does_no_harm),
        counted_test(a_spoiled_file_does_no_harm), counted_test(endless_files_are_refused),
        counted_test(the_memory_budget_holds),     counted_test(no_failed_allocation_loses_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
