# CPack runs this before packing: sets names and compression according to Debian's policy (12.1, 12.5, 12.7).
if(CPACK_GENERATOR STREQUAL "DEB")
  set(share ${CPACK_TEMPORARY_DIRECTORY}/usr/share)
  file(RENAME ${share}/doc/peclet/LICENSE ${share}/doc/peclet/copyright)
  file(RENAME ${share}/doc/peclet/CHANGELOG.md ${share}/doc/peclet/changelog)
  file(GLOB pages ${share}/man/man1/*.1)
  execute_process(COMMAND gzip -9n ${share}/doc/peclet/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
