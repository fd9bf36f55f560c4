"""Here rows become mean times beside the paper's, and numbers become text: Table 1 in every format."""
