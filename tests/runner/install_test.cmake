# Installs the build into a folder of its own and looks at what is there.
set(prefix ${BUILD}/install-test)
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

foreach(file
    bin/peclet
    bin/peclet-engine
    share/man/man1/peclet.1
    share/man/man1/peclet-run.1
    share/bash-completion/completions/peclet
    share/zsh/site-functions/_peclet
    share/fish/vendor_completions.d/peclet.fish
    share/systemd/user/peclet@.service)
  if(NOT EXISTS ${prefix}/${file})
    message(SEND_ERROR "${file} is not installed")
  endif()
endforeach()

# The engine is found beside peclet, wherever that is: without it the new campaign would be refused.
execute_process(COMMAND ${prefix}/bin/peclet init ${prefix}/campaign.json OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${prefix}/bin/peclet validate ${prefix}/campaign.json OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# Pages and scripts are those of the program.
foreach(verb run report)
  execute_process(COMMAND ${prefix}/bin/peclet manual ${verb} OUTPUT_VARIABLE page COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${prefix}/share/man/man1/peclet-${verb}.1 installed)
  if(NOT page STREQUAL installed)
    message(SEND_ERROR "peclet-${verb}.1 is not what the program says")
  endif()
endforeach()
file(REMOVE_RECURSE ${prefix})
