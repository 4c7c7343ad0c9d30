# Writes OUTPUT, a header that tells which sources the program is made of: git's tree ids of core, baselines and
# experiments as they stand in the work tree, committed or not, so that equal contents always give equal ids.
#
#   cmake -D SOURCE_DIR=... -D OUTPUT=... -P source_version.cmake
#
# Runs at every build, and touches OUTPUT only if something changed. Without git, or outside a repository of its own,
# the ids are "unknown".

cmake_minimum_required(VERSION 3.25)

set(parts core baselines experiments)
set(head unknown)
set(dirty true)
foreach(part IN LISTS parts)
  set(tree_${part} unknown)
endforeach()

# git, with an index and an object store of our own: the user's are only read. A hook's GIT_* must not lead elsewhere.
# The index stays from build to build, so that git need not hash unchanged files again.
function(run_git output)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env --unset=GIT_DIR --unset=GIT_WORK_TREE --unset=GIT_PREFIX
            "GIT_INDEX_FILE=${OUTPUT}.index" ${object_store} git -C "${SOURCE_DIR}" ${ARGN}
    OUTPUT_VARIABLE text RESULT_VARIABLE status ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT status EQUAL 0)
    set(text "")
  endif()
  set(${output} "${text}" PARENT_SCOPE)
endfunction()

function(read_trees)
  run_git(top rev-parse --show-toplevel)
  file(REAL_PATH "${SOURCE_DIR}" source)
  if(NOT top STREQUAL source)
    return() # a copy without its history, perhaps inside someone else's repository
  endif()
  run_git(objects rev-parse --path-format=absolute --git-path objects)
  file(MAKE_DIRECTORY "${OUTPUT}.objects")
  set(object_store "GIT_OBJECT_DIRECTORY=${OUTPUT}.objects" "GIT_ALTERNATE_OBJECT_DIRECTORIES=${objects}")
  run_git(ignored add --all -- ${parts})
  set(all_known true)
  foreach(part IN LISTS parts)
    run_git(tree write-tree --prefix=${part}/)
    run_git(committed rev-parse --verify --quiet HEAD:${part})
    if(NOT tree)
      set(tree unknown)
    endif()
    if(NOT tree STREQUAL committed)
      set(all_known false)
    endif()
    set(tree_${part} "${tree}" PARENT_SCOPE)
  endforeach()
  if(all_known)
    set(dirty false PARENT_SCOPE)
  endif()
  run_git(head_id rev-parse --verify --quiet HEAD)
  if(head_id)
    set(head "${head_id}" PARENT_SCOPE)
  endif()
endfunction()

read_trees()
file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[
#pragma once
// Made by source_version.cmake; do not edit.
namespace touchstone::harness {
inline constexpr const char* kCoreTree = "@tree_core@";
inline constexpr const char* kBaselinesTree = "@tree_baselines@";
inline constexpr const char* kExperimentsTree = "@tree_experiments@";
inline constexpr const char* kHeadCommit = "@head@";
inline constexpr bool kSourcesDirty = @dirty@;
}  // namespace touchstone::harness
]])
