// `one.wgsl` for four pixels at once.
alias Reals = vec4f;
alias Words = vec4u;
alias Bools = vec4<bool>;
