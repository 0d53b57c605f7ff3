# Run by venule_embed(): writes ${OUTPUT} from the files that ${OUTPUT}.list names, one a line.
file(STRINGS "${OUTPUT}.list" files)
string(REGEX REPLACE "_modules$" "" prefix "${VARIABLE}")

set(arrays "")
set(rows "")
set(count 0)
foreach(file IN LISTS files)
  file(RELATIVE_PATH module "${ROOT}" "${file}")
  string(REGEX REPLACE "\\.lua$" "" module "${module}")
  string(REGEX REPLACE "/init$" "" module "${module}")
  string(REPLACE "/" "." module "${module}")
  file(READ "${file}" bytes HEX)
  file(SIZE "${file}" size)
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  # The zero at the end is not counted: it makes an empty file legal C, and the text a C string.
  string(APPEND arrays "static const unsigned char module_${count}[] = {\n${bytes}0};\n\n")
  string(APPEND rows "    {\"${module}\", module_${count}, ${size}},\n")
  math(EXPR count "${count} + 1")
endforeach()

# The row of zeros likewise makes an empty table legal.
file(WRITE "${OUTPUT}" "// Made by cmake/embed_script.cmake from the files in lua/: change those.
#include \"bind/embedded.h\"

${arrays}const vn_embedded ${VARIABLE}[] = {\n${rows}    {0, 0, 0},\n};

const int ${prefix}_count = ${count};
")
