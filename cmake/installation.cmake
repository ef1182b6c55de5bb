# What is installed beside the programs: what they look for relative to themselves (runner/own_files.h), and what people
# read. Below share/peclet everything lies as it does in the source, so that links between the texts hold.

set(own ${CMAKE_INSTALL_DATADIR}/peclet)
set(unwanted PATTERN __pycache__ EXCLUDE PATTERN "*.peclet" EXCLUDE)

install(DIRECTORY adapters results templates DESTINATION ${own} USE_SOURCE_PERMISSIONS ${unwanted})
install(DIRECTORY schema DESTINATION ${own} FILES_MATCHING PATTERN "*.json" PATTERN "*.sql" PATTERN "*.md")
install(FILES README.md DESTINATION ${own})
install(FILES engine/PHYSICS.md DESTINATION ${own}/engine)
install(FILES runner/HANDOVER.md DESTINATION ${own}/runner)
if(EXISTS ${PROJECT_SOURCE_DIR}/docs)
  install(DIRECTORY docs DESTINATION ${own})
endif()

install(FILES CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(EXISTS ${PROJECT_SOURCE_DIR}/CITATION.cff)
  install(FILES CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

# Programs that carry libraries in them carry these libraries' licences with them.
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
