"""Solutions that owe nothing to the program: closed forms, quadratures, a conventional finite element rail."""
