"""Here every solver climbs: what each rung asks for, what closed forms expect there, one process a cell."""
