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

# ensemble_embed_table(TARGET SYMBOL FILE...): compiles text files into TARGET as an array of pairs of their names
# (without folder and ending) and texts, ensemble::SYMBOL in "embedded/SYMBOL.h", in the order given.
function(ensemble_embed_table target symbol)
  set(header ${PROJECT_BINARY_DIR}/embedded/${symbol}.h)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  list(JOIN sources "|" files)
  add_custom_command(
    OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} -DFILES=${files} -DHEADER=${header} -DSYMBOL=${symbol}
            -P ${PROJECT_SOURCE_DIR}/cmake/embed_table.cmake
    DEPENDS ${sources} ${PROJECT_SOURCE_DIR}/cmake/embed_table.cmake
    COMMENT "Embedding ${symbol}" VERBATIM)
  target_sources(${target} PRIVATE ${header})
endfunction()
