# add_rooms(PREFIX "LIBRARY..." ROOM...): a static library PREFIX_ROOM of each folder, from below to above. A room may
# include those before it and has the libraries in quotes; tests/house/layering.py reads the same list. Sources that end
# in _avx2.cpp or _avx512.cpp are added with flags of their own.
function(add_rooms prefix libraries)
  set(below ${libraries})
  foreach(room ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${room}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "_avx(2|512)\\.cpp$|/main\\.cpp$")
    add_library(${prefix}_${room} STATIC ${sources})
    target_link_libraries(${prefix}_${room} PUBLIC ${below})
    set_property(GLOBAL APPEND PROPERTY ${prefix}_libraries ${prefix}_${room})
    set(below ${prefix}_${room})
  endforeach()
endfunction()

# embed(LIBRARY TEMPLATE FILE...): TEMPLATE.cpp.in, in which @NAME_ENDING@ stands for the text of the file name.ending,
# becomes part of the library.
function(embed library template)
  foreach(path ${ARGN})
    cmake_path(GET path FILENAME name)
    string(MAKE_C_IDENTIFIER ${name} variable)
    string(TOUPPER ${variable} variable)
    file(READ ${path} ${variable})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  endforeach()
  cmake_path(GET template FILENAME name)
  configure_file(${template}.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp @ONLY)
  target_sources(${library} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
endfunction()
