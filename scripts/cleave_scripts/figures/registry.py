"""The figures of the report, in its order. A new figure is one file and one row here."""
import dataclasses

from cleave_scripts.figures import (interface_cost, kernel_value, ladder_map, motion_of_solvers, price_of_accuracy, speed_up,
                                    stages, times_by_combination, time_to_accuracy, times_by_size, times_by_step,
                                    trade_off, verdict_map)


@dataclasses.dataclass(frozen=True)
class Figure:
    name: str  # of the files
    title: str
    draw: object  # data -> (matplotlib figure, caption); raises NoData
    paper: bool = False  # one of the paper's


FIGURES = (
    Figure("figure3", "Figure 3: solve time of every example and combination", times_by_combination.draw,
           True),
    Figure("figure4", "Figure 4: solve time against the number of rocks", times_by_size.draw, True),
    Figure("figure5", "Figure 5: solve time of every step of Log Tower", times_by_step.draw, True),
    Figure("verdict_map", "The verdict map: what holds under which open choice", verdict_map.draw),
    Figure("trade_off", "What accuracy costs: time against error", trade_off.draw),
    Figure("price_of_accuracy", "What accuracy costs: by every solver on six steps", price_of_accuracy.price),
    Figure("time_to_accuracy", "What accuracy costs: time to every residual", time_to_accuracy.times),
    Figure("crossover", "What accuracy costs: where the exact solver overtakes those that iterate",
           time_to_accuracy.crossovers),
    Figure("accuracy_profile", "What accuracy costs: how near each solver is to the fastest", time_to_accuracy.profiles),
    Figure("tradeoff_motion", "What accuracy costs: what becomes of a scene that one solver moves", motion_of_solvers.motion),
    Figure("ladder", "The stability ladder: where each solver fails first", ladder_map.draw),
    Figure("stages", "Where the solve spends its time", stages.draw_combinations),
    Figure("stages_solvers", "Where other solvers spend theirs", stages.draw_solvers),
    Figure("interface_cost", "The price of interface rows", interface_cost.draw),
    Figure("speed_up", "Speed-up with more workers, modelled and measured", speed_up.draw),
    Figure("kernel_value", "What a better kernel does to the value of partitioning", kernel_value.draw),
)
