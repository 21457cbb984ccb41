"""One module per case: a function `compute(data)` that returns rows and a chart."""
