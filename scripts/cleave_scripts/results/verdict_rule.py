"""The rule by which claims of the paper are judged (figures/verdicts.py), in words."""
RULE = (
    "Every row is a figure that has to lie in a range: a gain (1 less the ratio of the mean times) above 0, "
    "or at least half of the paper's own figure where its text states a size; another range stands with the "
    "row. Only steps that all cells of a row have solved count. The 95 % interval comes from block "
    "bootstraps over the steps (2000 resamples, blocks of the cube root of the number of steps); it is the "
    "hull over repeated runs and over t_s_ms (median of the repeats) and t_s_min_ms (least). For the least "
    "of k gains it reaches from the least lower to the least upper end of the k intervals at 1 - 0.05 / k. "
    "The whole interval in the range: reproduced; all of it outside: not reproduced. If it straddles a "
    "limit, or there are fewer than five steps, timing cannot tell, and the same figure of two counted "
    "columns, equal on every machine, decides: million operations of a factorisation (Mflop) in the range, "
    "and interface rows too, of a gain above 0. Both hold: reproduced; neither: not reproduced. Where a size "
    "is stated, Mflop outside the range alone mean not reproduced, for interface rows say whether there is a "
    "gain and not how large it is. Else within noise. Open: the data do not have the cells.")
