# Checks CMake's messages at a first build: -D SOURCE=... -D FOLDER=... -P this
function(configure name)
  file(REMOVE_RECURSE ${FOLDER}/${name})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER}/${name} ${ARGN}
    RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  set(code ${code} PARENT_SCOPE)
  set(said "${said}" PARENT_SCOPE)
endfunction()

# All missing packages are named at once.
configure(bare -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DCMAKE_DISABLE_FIND_PACKAGE_ZLIB=ON
  -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON -DRANDOM123_INCLUDE=RANDOM123_INCLUDE-NOTFOUND -DCMAKE_SYSTEM_IGNORE_PATH=/usr/include)
foreach(package libcli11-dev zlib1g-dev libgtest-dev librandom123-dev)
  if(NOT said MATCHES "\\(${package}\\)")
    message(SEND_ERROR "${package} is not named")
  endif()
endforeach()
if(code EQUAL 0 OR NOT said MATCHES "-DBUILD_TESTING=OFF")
  message(SEND_ERROR "exit ${code}\n${said}")
endif()

# Programs without tests need no test packages, and other compilers' warnings are no errors.
configure(plain -DBUILD_TESTING=OFF -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON -DCMAKE_DISABLE_FIND_PACKAGE_Python3=ON)
if(NOT code EQUAL 0)
  message(SEND_ERROR "exit ${code}\n${said}")
endif()
file(READ ${FOLDER}/plain/compile_commands.json commands)
if(commands MATCHES "-Werror")
  message(SEND_ERROR "warnings are errors without PECLET_WERROR")
endif()

# The presets make warnings errors.
file(READ ${SOURCE}/CMakePresets.json presets)
if(NOT presets MATCHES "\"PECLET_WERROR\": \"ON\"")
  message(SEND_ERROR "the presets do not ask for PECLET_WERROR")
endif()
file(REMOVE_RECURSE ${FOLDER})
