# Manual page and shell completion. The program prints them when it is linked, so that `cmake --install` finds them
# whichever targets were built; a program for another machine cannot be run here.
if(NOT CMAKE_CROSSCOMPILING)
  set(manual_page ${CMAKE_CURRENT_BINARY_DIR}/quadedge.1)
  set(bash_completion ${CMAKE_CURRENT_BINARY_DIR}/quadedge.bash)
  add_custom_command(TARGET quadedge_program POST_BUILD
    COMMAND quadedge_program generate man > ${manual_page}
    COMMAND quadedge_program generate bash > ${bash_completion}
    BYPRODUCTS ${manual_page} ${bash_completion}
    VERBATIM)
endif()
