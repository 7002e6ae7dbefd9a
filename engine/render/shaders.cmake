# psygen_shaders(TARGET MESHES ... OTHERS ...) compiles GLSL from shaders/ to SPIR-V at build time,
# optimised and validated, and embeds it in TARGET. It writes two headers into the folder shaders/ of
# the build: shader_list.h has `enum class Shader`, shader_code.h the words in the same order.
find_program(PSYGEN_GLSLC glslc REQUIRED)
find_program(PSYGEN_SPIRV_VAL spirv-val)  # without it, shaders are not validated

function(psygen_shaders target)
  cmake_parse_arguments(ARG "" "" "MESHES;OTHERS" ${ARGN})
  set(shaders "")
  foreach(mesh IN LISTS ARG_MESHES)
    foreach(look "" ":PIXEL_LIGHT" ":DRAW_COLOUR" ":SHADOW")
      list(APPEND shaders ${mesh}${look} ${mesh}${look}:DRAW_PUSHED)
    endforeach()
  endforeach()
  list(APPEND shaders ${ARG_OTHERS})

  set(glsl ${PROJECT_SOURCE_DIR}/shaders)
  set(built ${CMAKE_CURRENT_BINARY_DIR}/shaders)
  file(MAKE_DIRECTORY ${built})
  set(headers "")
  set(enumerators "")
  set(arrays "")
  set(table "")
  foreach(shader IN LISTS shaders)
    string(REPLACE ":" ";" defines ${shader})
    list(POP_FRONT defines file)
    get_filename_component(stem ${file} NAME_WE)
    get_filename_component(stage ${file} EXT)
    string(SUBSTRING ${stage} 1 -1 stage)
    set(all_defines ${defines})
    if(stage STREQUAL "glsl")  # both stages in one file
      list(POP_FRONT defines stage)
      string(TOLOWER ${stage} stage)
    endif()
    list(JOIN defines "_" how)
    string(TOLOWER "${stem}_${how}_${stage}" name)
    string(REPLACE "__" "_" name ${name})
    set(enumerator k)
    string(REPLACE "_" ";" words ${name})
    foreach(word IN LISTS words)
      string(SUBSTRING ${word} 0 1 first)
      string(SUBSTRING ${word} 1 -1 rest)
      string(TOUPPER ${first} first)
      string(APPEND enumerator ${first}${rest})
    endforeach()
    list(TRANSFORM all_defines PREPEND -DPSYGEN_)
    set(flags --target-env=vulkan1.3 -fshader-stage=${stage} -O -Werror ${all_defines} -I ${glsl})
    set(header ${built}/${name}_spv.h)
    set(validate "")
    if(PSYGEN_SPIRV_VAL)
      set(validate COMMAND ${PSYGEN_SPIRV_VAL} --target-env vulkan1.3 ${built}/${name}.spv)
    endif()
    add_custom_command(
      OUTPUT ${header} BYPRODUCTS ${built}/${name}.spv
      COMMAND ${PSYGEN_GLSLC} ${flags} ${glsl}/${file} -o ${built}/${name}.spv
      ${validate}
      COMMAND ${PSYGEN_GLSLC} ${flags} -MD -MF ${header}.d -MT ${header} -mfmt=c ${glsl}/${file} -o ${header}
      DEPENDS ${glsl}/${file} DEPFILE ${header}.d
      COMMENT "Compiling shader ${name}" VERBATIM)
    list(APPEND headers ${header})
    string(APPEND enumerators "  ${enumerator},\n")
    string(APPEND arrays "constexpr std::uint32_t ${enumerator}[] =\n#include \"${name}_spv.h\"\n    ;\n")
    string(APPEND table "    ${enumerator},\n")
  endforeach()
  set(note "// Written by engine/render/shaders.cmake.\n")
  file(CONFIGURE OUTPUT ${built}/shader_list.h @ONLY CONTENT
       "@note@#pragma once\n#include <cstdint>\nnamespace psygen::render {\nenum class Shader : std::uint8_t {\n@enumerators@};\n}  // namespace psygen::render\n")
  file(CONFIGURE OUTPUT ${built}/shader_code.h @ONLY CONTENT
       "@note@@arrays@constexpr ShaderCode kShaders[] = {\n@table@};\n")
  add_custom_target(${target}_shaders DEPENDS ${headers})
  add_dependencies(${target} ${target}_shaders)
endfunction()
