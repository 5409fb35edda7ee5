"""Both bodies in space: stills, an interactive window, and a time series for ParaView."""
