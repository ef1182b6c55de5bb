# Finds all dependencies of building and testing. Lists all that are missing at once, with their Debian packages.

set(missing "")

# package(NAME PACKAGE [ARGUMENT...]): calls find_package(NAME ARGUMENT...); PACKAGE is the Debian package.
macro(package name debian)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    list(APPEND missing "${name} (${debian})")
  endif()
endmacro()

if(PECLET_ARCHIVES)
  # With PECLET_STATIC also of the C library: the programs run on any Linux, with the same mathematical functions.
  set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
  # The archive of OpenMP is in a folder that only g++ knows.
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
  if(PECLET_FROM_SOURCE)
    find_path(GOOGLETEST_SOURCE googletest/src/gtest-all.cc PATHS /usr/src/googletest NO_CMAKE_FIND_ROOT_PATH)
    if(NOT GOOGLETEST_SOURCE)
      list(APPEND missing "source of GTest (googletest)")
    endif()
  else()
    package(GTest libgtest-dev)
  endif()
  package(Python3 python3 COMPONENTS Interpreter)
endif()

if(missing)
  list(JOIN missing "\n  " list)
  set(cure "`./bootstrap.sh deps` installs what Debian has.")
  if(BUILD_TESTING)
    string(APPEND cure " Only the tests need GTest and Python; -DBUILD_TESTING=OFF leaves them out.")
  endif()
  message(FATAL_ERROR "Not found (Debian's package):\n  ${list}\n${cure}")
endif()

# Eigen must not divide large products among OpenMP threads, nor include files with other licences than the MPL.
target_compile_definitions(Eigen3::Eigen INTERFACE EIGEN_DONT_PARALLELIZE EIGEN_MPL2_ONLY
  $<$<CONFIG:Release>:EIGEN_NO_DEBUG>)

# Asio of Boost 1.74 takes std::result_of otherwise, which C++20 does not have.
target_compile_definitions(Boost::headers INTERFACE BOOST_ASIO_HAS_STD_INVOKE_RESULT)

# Debian has fmt and spdlog as shared libraries only, for the C++ library of g++. Their archives are compiled here from
# their headers, which have the sources. All other code is compiled as for the shared libraries.
if(PECLET_ARCHIVES OR PECLET_FROM_SOURCE)
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

if(BUILD_TESTING AND PECLET_FROM_SOURCE)
  set(BUILD_GMOCK OFF)
  set(INSTALL_GTEST OFF)
  add_subdirectory(${GOOGLETEST_SOURCE} googletest EXCLUDE_FROM_ALL)
endif()
