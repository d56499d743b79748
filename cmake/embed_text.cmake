# Run by ensemble_embed: writes HEADER with the text of SOURCE as a constant named SYMBOL.
file(READ ${SOURCE} text)
file(WRITE ${HEADER}
  "#pragma once\nnamespace ensemble {\ninline constexpr char ${SYMBOL}[] = R\"__(${text})__\";\n}\n")
