# add_rooms(PREFIX "LIBRARY..." ROOM...): adds a static library PREFIX_ROOM for each folder, from bottom to top. A
# folder may include those before it, and links the libraries in quotes; tests/house/layering.py reads the same list.
# Sources that end in _avx2.cpp or _avx512.cpp are added elsewhere, with their own flags.
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

# embed(LIBRARY TEMPLATE FILE...): adds TEMPLATE.cpp.in to the library, with the text of the file name.ending in the
# place of @NAME_ENDING@. @TEXT_BY_NAME@ is all of them, each as {"folder-name", R"text(...)text"},.
function(embed library template)
  foreach(path ${ARGN})
    cmake_path(GET path FILENAME name)
    string(MAKE_C_IDENTIFIER ${name} variable)
    string(TOUPPER ${variable} variable)
    file(READ ${path} ${variable})
    cmake_path(GET path PARENT_PATH folder)
    cmake_path(GET folder FILENAME folder)
    cmake_path(GET path STEM LAST_ONLY stem)
    string(APPEND TEXT_BY_NAME "{\"${folder}-${stem}\", R\"text(${${variable}})text\"},\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  endforeach()
  cmake_path(GET template FILENAME name)
  configure_file(${template}.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp @ONLY)
  target_sources(${library} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
endfunction()
