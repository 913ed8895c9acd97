# What `cmake --install` and `cpack` put where, in two components: the program with its presets and documentation, and
# what other projects need to build with the library. cpack makes a Debian package of each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/quadedge)

if(TARGET quadedge_program)
  install(TARGETS quadedge_program)
endif()
if(DEFINED manual_page)
  install(FILES ${manual_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
install(FILES cmake/quadedge.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME quadedge)
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/quadedge FILES_MATCHING PATTERN *.toml)
install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY doc DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN *.md EXCLUDE)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(CODE "execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}\"
  \"-DDOCUMENTS=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}\"
  \"-DPRESETS=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/quadedge\"
  -P \"${CMAKE_CURRENT_SOURCE_DIR}/cmake/install_pages.cmake\" COMMAND_ERROR_IS_FATAL ANY)")

install(TARGETS ${exported_targets} EXPORT quadedge_targets COMPONENT development)
install(DIRECTORY include/quadedge DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT quadedge_targets NAMESPACE quadedge:: DESTINATION ${package_folder} COMPONENT development)
# python/CMakeLists.txt takes the library from here, too.
export(TARGETS ${shareable_targets} quadedge_options NAMESPACE quadedge::
  FILE ${CMAKE_BINARY_DIR}/quadedge_targets.cmake)
configure_package_config_file(cmake/quadedgeConfig.cmake.in quadedgeConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(quadedgeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/quadedgeConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/quadedgeConfigVersion.cmake
  cmake/FindOpenCVModules.cmake DESTINATION ${package_folder} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME quadedge)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "stereo visual odometry from edge quads")
set(CPACK_PACKAGE_CONTACT "QuadEdge contributors <quadedge@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)  # xz would take five times as long for a file 20 % smaller

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME quadedge)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "Tracks the motion of a stereo camera from its images: third-order edges are
matched between left and right and between two times, in OpenCL.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "pocl-opencl-icd, ffmpeg")  # a device without a GPU; videos

# What quadedgeConfig.cmake looks for: development_packages of cmake/dependencies.cmake.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libquadedge-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Static libraries, headers, CMake configuration and examples.")
list(JOIN development_packages ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "pocl-opencl-icd, ffmpeg")
set(CPACK_COMPONENTS_ALL program development)
include(CPack)
