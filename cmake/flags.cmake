# What every target of this project is compiled with.
add_library(venule_flags INTERFACE)
target_compile_options(venule_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wpointer-arith -Wvla -Wundef
  $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes;-Wmissing-prototypes>
  # Contracted multiply-adds round differently from one compiler to another; results must not.
  -ffp-contract=off
  $<$<BOOL:${VN_WERROR}>:-Werror>)
if(VN_SANITIZE)
  target_compile_options(venule_flags INTERFACE -fsanitize=${VN_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer)
  target_link_options(venule_flags INTERFACE -fsanitize=${VN_SANITIZE})
endif()
