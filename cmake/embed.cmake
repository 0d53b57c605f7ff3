# venule_embed(<target> <variable> <output.c> <file.lua>...)
#
# Compiles Lua files into <target> as the table <variable> of vn_embedded and <variable without _modules>_count
# (lua/bind/embedded.h). The C source is made at build time and made again when a file or the list of files changes.
# A module is called after its path: lua/venule/venation.lua is "venule.venation".
function(venule_embed target variable output)
  if(NOT IS_ABSOLUTE "${output}")
    set(output "${CMAKE_CURRENT_BINARY_DIR}/${output}")
  endif()
  set(files)
  foreach(file IN LISTS ARGN)
    get_filename_component(file "${file}" ABSOLUTE)
    list(APPEND files "${file}")
  endforeach()
  # The list travels in a file of its own: a semicolon or a space in a path survives no command line.
  string(REPLACE ";" "\n" list_text "${files}")
  file(CONFIGURE OUTPUT "${output}.list" CONTENT "${list_text}\n" @ONLY)
  set(script "${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake")
  add_custom_command(
    OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DVARIABLE=${variable}" "-DOUTPUT=${output}" "-DROOT=${PROJECT_SOURCE_DIR}/lua"
            -P "${script}"
    DEPENDS ${files} "${script}" "${output}.list"
    COMMENT "Embedding the Lua modules of ${target}"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()
