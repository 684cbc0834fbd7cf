"""Forward models: named inputs (parameters and conditions alike) in, named observables out."""
