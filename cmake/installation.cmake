# Installs files that the programs find relative to themselves (own_file() in runner/store/campaign_directory.h), and
# pages. share/peclet has the structure of the source, so that links between pages work.

set(own ${CMAKE_INSTALL_DATADIR}/peclet)
set(unwanted PATTERN __pycache__ EXCLUDE PATTERN "*.peclet" EXCLUDE)

install(DIRECTORY adapters results templates DESTINATION ${own} USE_SOURCE_PERMISSIONS ${unwanted})
install(DIRECTORY schema DESTINATION ${own} FILES_MATCHING PATTERN "*.json" PATTERN "*.sql" PATTERN "*.md")
install(DIRECTORY docs DESTINATION ${own})
# With the prefix /usr this is in the path of Debian's python3.
install(DIRECTORY python/peclet DESTINATION lib/python3/dist-packages ${unwanted})
# Further pages that these pages link to; tests/pages/links.py checks the installed ones.
foreach(page README.md CHANGELOG.md CONTRIBUTING.md LICENSE CITATION.cff paper.md engine/PHYSICS.md runner/HANDOVER.md tests/bench/README.md
    tests/end_to_end/README.md tests/end_to_end/MISTAKES.md tests/mutations/mutations.md tests/physics/README.md
    tests/reference/README.md tests/reference/forces/README.md)
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${page} DESTINATION ${own}/${folder})
endforeach()

install(FILES CHANGELOG.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Licences of the libraries that static programs contain.
if(PECLET_STATIC)
  foreach(library libboost-dev libc6-dev libcli11-dev libeigen3-dev libfmt-dev librandom123-dev libsodium-dev libspdlog-dev libsqlite3-dev
      libstdc++-12-dev nlohmann-json3-dev zlib1g-dev)
    set(licence /usr/share/doc/${library}/copyright)
    if(NOT EXISTS ${licence})
      message(FATAL_ERROR "${licence}: missing; PECLET_STATIC is for building packages on Debian 12")
    endif()
    install(FILES ${licence} DESTINATION ${CMAKE_INSTALL_DOCDIR}/licences RENAME ${library})
  endforeach()
endif()
