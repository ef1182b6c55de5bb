# Installs the build into a folder of its own, moves the folder, and checks that its files are there and work.
set(prefix ${BUILD}/install-test)
file(REMOVE_RECURSE ${prefix} ${prefix}-moved)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${prefix} ${prefix}-moved)
set(prefix ${prefix}-moved)

find_program(HELP2MAN help2man)
if(HELP2MAN)
  set(pages share/man/man1/peclet.1 share/man/man1/peclet-run.1)
endif()
foreach(file
    bin/peclet
    bin/peclet-engine
    lib/python3/dist-packages/peclet/__init__.py
    lib/python3/dist-packages/peclet/answer.py
    lib/python3/dist-packages/peclet/laws_report.py
    share/doc/peclet/LICENSE
    ${pages}
    share/bash-completion/completions/peclet
    share/peclet/adapters/lammps/README.md
    share/peclet/adapters/lammps/lammps_engine.py
    share/peclet/results/demo/campaign.json
    share/peclet/results/run.py
    share/peclet/schema/result.schema.json
    share/systemd/user/peclet@.service)
  if(NOT EXISTS ${prefix}/${file})
    message(SEND_ERROR "${file} is not installed")
  endif()
endforeach()

# Links between the pages hold where they were installed, too.
execute_process(COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/../../pages/links.py ${prefix}/share/peclet
  RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT code EQUAL 0)
  message(SEND_ERROR "the installed pages: ${code}\n${said}")
endif()

# The engine is found beside peclet, wherever that is: without it the new campaign would be refused.
execute_process(COMMAND ${prefix}/bin/peclet init ${prefix}/campaign.json OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${prefix}/bin/peclet validate ${prefix}/campaign.json OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# The studies that were installed find the programs that were installed with them.
set(run ${prefix}/share/peclet/results/run.py)
file(MAKE_DIRECTORY ${prefix}/share/peclet/results/only-installed)
file(WRITE ${prefix}/share/peclet/results/only-installed/study.py
  "import sys\nsys.exit(3 if sys.argv[1:] == ['${prefix}/bin', '--quick'] else 4)\n")
execute_process(COMMAND ${run} OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${run} only-installed --quick RESULT_VARIABLE code)
if(NOT list MATCHES "only-installed +not yet" OR NOT list MATCHES "zero-shear" OR NOT code EQUAL 3)
  message(SEND_ERROR "the installed studies are not found: ${code}\n${list}")
endif()

# The adapter is found by its name alone, from an unrelated folder.
set(ensemble ${prefix}/ensemble)
foreach(part dumbbells.in dumbbell.mol)
  file(COPY ${prefix}/share/peclet/results/lammps-ensemble/${part} DESTINATION ${ensemble})
endforeach()
file(READ ${prefix}/share/peclet/results/lammps-ensemble/campaign.json campaign)
string(JSON campaign SET "${campaign}" engine 0 "\"lammps_engine.py\"")
file(WRITE ${ensemble}/campaign.json "${campaign}")
execute_process(COMMAND ${prefix}/bin/peclet validate ${ensemble}/campaign.json RESULT_VARIABLE code
  OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT code EQUAL 0)
  message(SEND_ERROR "the adapter is not found by its name: ${code}\n${said}")
endif()

file(REMOVE_RECURSE ${prefix})
