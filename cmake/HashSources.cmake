# Writes OUTPUT with the hash of the contents of the files in LIST, whatever the folder they are in.
file(STRINGS "${LIST}" sources)
set(hashes "")
foreach(source IN LISTS sources)
  file(SHA256 "${source}" hash)
  string(APPEND hashes "${hash}")
endforeach()
string(SHA256 version "${hashes}")
string(SUBSTRING "${version}" 0 12 version)
file(WRITE "${OUTPUT}" "#include \"rift/sweep/falsify/simulated_trial.hpp\"\n\n"
     "namespace rift::sweep {\n\n"
     "std::string_view PhysicsVersion() { return \"${version}\"; }\n\n}  // namespace rift::sweep\n")
