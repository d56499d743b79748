# ensemble_embed(TARGET FILE SYMBOL): compiles a text file into TARGET as
# `extern const char ensemble::SYMBOL[]`, declared in "embedded/SYMBOL.h".
function(ensemble_embed target file symbol)
  set(source ${CMAKE_CURRENT_SOURCE_DIR}/${file})
  set(header ${PROJECT_BINARY_DIR}/embedded/${symbol}.h)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DHEADER=${header} -DSYMBOL=${symbol}
            -P ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake
    DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake
    COMMENT "Embedding ${file}" VERBATIM)
  target_sources(${target} PRIVATE ${header})
endfunction()
