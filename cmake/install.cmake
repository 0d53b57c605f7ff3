# What `cmake --install` puts where. Every path follows --prefix, so that an installation can be moved.
include(CMakePackageConfigHelpers)

set(venule_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/venule")
set(venule_data_dir "${CMAKE_INSTALL_DATADIR}/venule")

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/venule" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        FILES_MATCHING PATTERN "*.h")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# Two export sets: who links the shared library need not have what the static one is linked with.
set_target_properties(venule_static PROPERTIES EXPORT_NAME static)
set_target_properties(venule_shared PROPERTIES EXPORT_NAME venule)
foreach(kind static shared)
  install(TARGETS venule_${kind} EXPORT venule-${kind}-targets
          LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
          ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(EXPORT venule-${kind}-targets NAMESPACE venule:: DESTINATION "${venule_cmake_dir}")
endforeach()

if(TARGET venule)
  install(TARGETS venule RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()
if(TARGET venule_module)
  install(TARGETS venule_module LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/lua/5.4")
endif()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/lua/venule" DESTINATION "${venule_data_dir}/lua" OPTIONAL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/lua/library" DESTINATION "${venule_data_dir}/lua" OPTIONAL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/scripts" DESTINATION "${venule_data_dir}" OPTIONAL)

# pkg-config
file(RELATIVE_PATH venule_pc_up "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" venule_pc_up "${venule_pc_up}")
# GCC's OpenMP is on every linker's path by its name; clang's is not, and is not the same library.
set(venule_pc_openmp "")
foreach(name IN LISTS OpenMP_C_LIB_NAMES)
  if(CMAKE_C_COMPILER_ID STREQUAL "GNU" OR name STREQUAL "pthread")
    string(APPEND venule_pc_openmp "-l${name} ")
  else()
    string(APPEND venule_pc_openmp "${OpenMP_${name}_LIBRARY} ")
  endif()
endforeach()
configure_file("${PROJECT_SOURCE_DIR}/cmake/venule.pc.in" "${PROJECT_BINARY_DIR}/venule.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/venule.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")

# find_package(venule)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/venule-config.cmake.in"
                              "${PROJECT_BINARY_DIR}/venule-config.cmake" INSTALL_DESTINATION "${venule_cmake_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/venule-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/venule-config.cmake" "${PROJECT_BINARY_DIR}/venule-config-version.cmake"
        DESTINATION "${venule_cmake_dir}")
