# Manual page and shell completion, printed by the program itself; a program for another machine cannot be asked.
if(NOT CMAKE_CROSSCOMPILING)
  set(manual_page ${CMAKE_CURRENT_BINARY_DIR}/quadedge.1)
  set(bash_completion ${CMAKE_CURRENT_BINARY_DIR}/quadedge.bash)
  add_custom_command(OUTPUT ${manual_page} ${bash_completion}
    COMMAND quadedge_program generate man > ${manual_page}
    COMMAND quadedge_program generate bash > ${bash_completion}
    DEPENDS quadedge_program
    VERBATIM)
  add_custom_target(quadedge_pages ALL DEPENDS ${manual_page} ${bash_completion})
endif()
