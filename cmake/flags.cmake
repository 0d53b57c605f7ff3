# What every target of this project is compiled with.
add_library(venule_flags INTERFACE)
target_compile_options(venule_flags INTERFACE
  -D_POSIX_C_SOURCE=200809L
  -Wall -Wextra -Wpedantic -Wshadow -Wpointer-arith -Wvla -Wundef
  $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes;-Wmissing-prototypes>
  # Contracted multiply-adds round differently from one compiler to another; results must not.
  -ffp-contract=off
  # Nobody reads errno or traps after arithmetic here; without them loops become vectors. No result changes.
  -fno-math-errno -fno-trapping-math
  $<$<BOOL:${VN_WERROR}>:-Werror>)
if(VN_SANITIZE)
  target_compile_options(venule_flags INTERFACE -fsanitize=${VN_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer)
  target_link_options(venule_flags INTERFACE -fsanitize=${VN_SANITIZE})
endif()
