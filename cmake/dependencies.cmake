# Everything that building and testing needs, found here and nowhere else. What is missing is named at once, with the
# Debian package that has it.

set(missing "")

# package(NAME PACKAGE [ARGUMENT...]): find_package(NAME ARGUMENT...), which Debian has in PACKAGE.
macro(package name debian)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    list(APPEND missing "${name} (${debian})")
  endif()
endmacro()

if(PECLET_STATIC)
  # Archives only, of the C library, too: the programs then run wherever Linux does, and their mathematical functions
  # are the same everywhere.
  set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
  # g++ keeps its archive of OpenMP where only g++ looks.
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libgomp.a
    OUTPUT_VARIABLE libgomp OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(OpenMP_gomp_LIBRARY ${libgomp} CACHE FILEPATH "libgomp as an archive")
endif()

package(CLI11 libcli11-dev)
package(Eigen3 libeigen3-dev 3.4 NO_MODULE)
package(fmt libfmt-dev)
package(nlohmann_json nlohmann-json3-dev)
package(OpenMP g++ COMPONENTS CXX)
package(spdlog libspdlog-dev)
package(SQLite3 libsqlite3-dev)
package(Threads libc6-dev)
package(Boost libboost-dev)  # headers only: Student's t, Asio and Beast
package(ZLIB zlib1g-dev)
package(PkgConfig pkg-config)
if(PkgConfig_FOUND)
  pkg_check_modules(sodium QUIET IMPORTED_TARGET libsodium)
  if(NOT sodium_FOUND)
    list(APPEND missing "libsodium (libsodium-dev)")
  endif()
endif()
find_path(RANDOM123_INCLUDE Random123/threefry.h)
if(NOT RANDOM123_INCLUDE)
  list(APPEND missing "Random123 (librandom123-dev)")
endif()
if(BUILD_TESTING)
  package(GTest libgtest-dev)
  package(Python3 python3 COMPONENTS Interpreter)
endif()

if(missing)
  list(JOIN missing "\n  " list)
  set(cure "`./bootstrap.sh deps` installs what Debian has.")
  if(BUILD_TESTING)
    string(APPEND cure " The tests need GTest and Python: -DBUILD_TESTING=OFF does without.")
  endif()
  message(FATAL_ERROR "Not found (Debian's package):\n  ${list}\n${cure}")
endif()

# Eigen would share large products among OpenMP's threads, unasked; and files of it under another licence than the MPL
# are refused.
target_compile_definitions(Eigen3::Eigen INTERFACE EIGEN_DONT_PARALLELIZE EIGEN_MPL2_ONLY
  $<$<CONFIG:Release>:EIGEN_NO_DEBUG>)

# Debian has fmt and spdlog as shared libraries only. Their archives are compiled here, from the headers, which hold the
# sources; everything else is compiled as it is for the shared ones.
if(PECLET_STATIC)
  foreach(library fmt spdlog)
    add_library(${library}_archive STATIC cmake/archives/${library}.cpp)
    foreach(property COMPILE_DEFINITIONS INCLUDE_DIRECTORIES)
      get_target_property(value ${library}::${library} INTERFACE_${property})
      if(value)
        set_target_properties(${library}_archive PROPERTIES ${property} "${value}" INTERFACE_${property} "${value}")
      endif()
    endforeach()
    add_library(peclet_${library} ALIAS ${library}_archive)
  endforeach()
  target_link_libraries(spdlog_archive PUBLIC fmt_archive Threads::Threads)
else()
  add_library(peclet_fmt ALIAS fmt::fmt)
  add_library(peclet_spdlog ALIAS spdlog::spdlog)
endif()
