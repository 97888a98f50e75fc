# Compiles the files of a folder together, twelve at a time. They take 0.6 times as long, for what they include and
# instantiate in common. Names in anonymous namespaces are therefore unique within a folder. Tables of fields, which
# abbreviate their rows' types, are compiled alone.
function(gumshoe_compile_folders_at_once target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source ${ARGN})
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE place)
    cmake_path(GET place PARENT_PATH folder)
    if(source MATCHES "_fields\\.cpp$" OR folder MATCHES "^\\.\\.")
      continue()
    endif()
    string(MAKE_C_IDENTIFIER ${folder} name)
    list(APPEND files_${name} ${source})
    list(LENGTH files_${name} number)
    math(EXPR group "(${number} - 1) / 12")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name}_${group})
  endforeach()
endfunction()
