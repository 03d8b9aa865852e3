"""One family of routes a file; ROUTERS holds them in the order of the API's description."""

from looplab.api.routes import (
    compare,
    connect,
    experiments,
    frequency,
    gain_map,
    health,
    identify,
    labs,
    laplace,
    loop,
    model_steady_states,
    models,
    optimal_tuning,
    plant_steady_states,
    plants,
    response,
    root_locus,
    routh,
    stability,
    state_feedback,
    state_space,
    tune,
)

ROUTERS = tuple(
    family.router
    for family in (
        health,
        loop,
        connect,
        frequency,
        root_locus,
        tune,
        optimal_tuning,
        compare,
        gain_map,
        identify,
        experiments,
        laplace,
        routh,
        stability,
        response,
        state_space,
        state_feedback,
        plants,
        plant_steady_states,
        models,
        model_steady_states,
        labs,
    )
)
