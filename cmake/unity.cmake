# What is not on the way of a frame is compiled with this instead of -O3, in two thirds of the time. Whether a value is
# set is seen at higher levels only.
set(quadedge_brief_options $<$<CONFIG:Release>:-O1> $<$<CONFIG:Release>:-Wno-maybe-uninitialized>)

# quadedge_unity(TARGET [BRIEF...]) compiles up to a dozen files of a folder as one translation unit: most of the time
# goes into headers. Names that files have for themselves differ within a folder, or the compiler says so. Files with
# compiler options of their own stay alone, as CMake has it. The files BRIEF have quadedge_brief_options, and units of
# their own.
function(quadedge_unity target)
  if(NOT QUADEDGE_UNITY)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "${quadedge_brief_options}")
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(IS_PREFIX PROJECT_SOURCE_DIR ${source} NORMALIZE is_ours)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${source} NORMALIZE is_generated)
    if(NOT is_ours OR is_generated)
      continue()
    endif()
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME folder)
    if(source IN_LIST ARGN)
      string(APPEND folder _brief)
    endif()
    list(APPEND in_${folder} ${source})
    list(LENGTH in_${folder} count)
    math(EXPR group "(${count} - 1) / 12")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
    if(source IN_LIST ARGN)
      set_source_files_properties(
        ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/Unity/unity_${folder}_${group}_cxx.cxx
        PROPERTIES COMPILE_OPTIONS "${quadedge_brief_options}")
    endif()
  endforeach()
endfunction()
