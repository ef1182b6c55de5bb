# The long form of the fuzzer of the live server; the short one is LiveServer.AnswersWhateverIsAskedOfIt.
add_executable(http_fuzz
  ${CMAKE_CURRENT_LIST_DIR}/http_fuzz.cpp
  ${CMAKE_CURRENT_LIST_DIR}/http_fuzzing.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../runner/runner_fixture.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../runner/stored_campaign.cpp)
target_link_libraries(http_fuzz PRIVATE peclet_runner_live GTest::gtest Threads::Threads)
