# `cpack --preset package` makes a .tar.gz for any Linux and a .deb with identical programs, so that their results
# belong to the same engine. Only statically linked programs are packed.

set(CPACK_PACKAGE_NAME peclet)
set(CPACK_PACKAGE_VENDOR "the peclet authors")
set(CPACK_PACKAGE_CONTACT "the peclet authors <maintainers@peclet.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ensemble averages of dense suspensions, to the accuracy asked for")
set(CPACK_PACKAGE_DESCRIPTION "A work queue that adds seeds to the points of a sweep until each mean is known
to its tolerance, and a particle engine for sheared dense suspensions with
contact, friction, lubrication and Brownian forces. Campaigns can be killed at
any moment and go on to the same bytes.")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)

string(TOLOWER "${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}" machine)
set(CPACK_PACKAGE_FILE_NAME peclet-${PROJECT_VERSION}-${machine})
set(CPACK_GENERATOR TGZ DEB)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# No `Depends`: the programs are linked statically. Python is needed for `peclet jamming` and `fit`, the studies, the
# adapter of LAMMPS, and figures.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3, python3-numpy, python3-scipy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "lammps, python3-matplotlib")
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/as_debian_wants.cmake)

if(PECLET_STATIC)
  include(CPack)
endif()
