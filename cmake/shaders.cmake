# ensemble_shader(TARGET FILE): compiles shaders/FILE to SPIR-V for Vulkan 1.3 and embeds it as the
# array `kNAME_STAGE` in "spirv/FILE.h" (crowd.vert -> spirv/crowd.vert.h, kCrowdVert -> see renderer).
function(ensemble_shader target file symbol)
  set(source ${PROJECT_SOURCE_DIR}/shaders/${file})
  set(header ${PROJECT_BINARY_DIR}/spirv/${file}.h)
  file(GLOB shared CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*.glsl
       ${PROJECT_SOURCE_DIR}/shaders/shared/*.h)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/spirv
    COMMAND Vulkan::glslangValidator --quiet --target-env vulkan1.3 -Od --vn ${symbol}
            -I${PROJECT_SOURCE_DIR} -o ${header} ${source}
    DEPENDS ${source} ${shared}
    COMMENT "Shader ${file}" VERBATIM)
  target_sources(${target} PRIVATE ${header})
endfunction()
