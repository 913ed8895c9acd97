# Single modules of OpenCV. The package configuration of Debian's libopencv-dev is of one piece: it asks for the files
# of all modules, so that find_package(OpenCV) would need all 50 of them.
#   find_package(OpenCVModules 4.5 REQUIRED COMPONENTS core imgproc)
# gives the targets OpenCVModules::core and OpenCVModules::imgproc, and their list OpenCVModules_LIBRARIES.
find_path(OpenCVModules_INCLUDE_DIR opencv2/core/version.hpp PATH_SUFFIXES opencv4)
mark_as_advanced(OpenCVModules_INCLUDE_DIR)
if(OpenCVModules_INCLUDE_DIR)
  file(STRINGS ${OpenCVModules_INCLUDE_DIR}/opencv2/core/version.hpp version_lines
    REGEX "#define CV_VERSION_(MAJOR|MINOR|REVISION) ")
  string(REGEX MATCHALL "[0-9]+" OpenCVModules_VERSION "${version_lines}")
  list(JOIN OpenCVModules_VERSION . OpenCVModules_VERSION)
  unset(version_lines)
endif()

set(OpenCVModules_LIBRARIES "")
foreach(module IN LISTS OpenCVModules_FIND_COMPONENTS)
  find_library(OpenCVModules_${module}_LIBRARY opencv_${module})
  mark_as_advanced(OpenCVModules_${module}_LIBRARY)
  if(NOT OpenCVModules_${module}_LIBRARY OR NOT EXISTS ${OpenCVModules_INCLUDE_DIR}/opencv2/${module}.hpp)
    continue()
  endif()
  set(OpenCVModules_${module}_FOUND TRUE)
  list(APPEND OpenCVModules_LIBRARIES OpenCVModules::${module})
  if(NOT TARGET OpenCVModules::${module})
    add_library(OpenCVModules::${module} UNKNOWN IMPORTED)
    set_target_properties(OpenCVModules::${module} PROPERTIES IMPORTED_LOCATION ${OpenCVModules_${module}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${OpenCVModules_INCLUDE_DIR})
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVModules REQUIRED_VARS OpenCVModules_INCLUDE_DIR
  VERSION_VAR OpenCVModules_VERSION HANDLE_COMPONENTS)
