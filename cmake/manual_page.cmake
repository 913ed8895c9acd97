# The manual page is written when the program is linked, so that `cmake --install` finds it whichever targets were
# built; a program for another machine cannot be run here.
if(NOT CMAKE_CROSSCOMPILING)
  set(manual_page ${CMAKE_CURRENT_BINARY_DIR}/quadedge.1)
  add_custom_command(TARGET quadedge_program POST_BUILD
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/cmake/manual_page.sh $<TARGET_FILE:quadedge_program> > ${manual_page}
    BYPRODUCTS ${manual_page}
    VERBATIM)
endif()
